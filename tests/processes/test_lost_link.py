"""Flights in processes whose links never come back: they end in the declared safe state, by positions too."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.services.cli import main
from cratous.services.processes import flight

VEHICLE: dict[str, Any] = {
    "id": 1, "position": {"north_m": 0, "east_m": 0, "alt_m": 300}, "heading_deg": 0, "speed_m_s": 22,
    "min_speed_m_s": 15, "max_speed_m_s": 33, "max_bank_deg": 30, "max_climb_m_s": 5,
}  # fmt: skip
POINT = {"id": 1, "kind": "must_fly", "points": [{"north_m": 4000, "east_m": 0, "alt_m": 300}]}
HEAD_ON = {
    "id": 9,
    "position": {"north_m": 5000, "east_m": 60, "alt_m": 300},
    "velocity": {"north_m_s": -24, "east_m_s": 0},
}
"""ICAROUS takes over for it from 31.5 s to 45 s."""
CIRCLE, ALONE = "circle of vehicle 1 at the end", "what vehicle 1 flies without the link"
TIMES = {"safe_state_after_s": 35}
IN_HAND = {
    "traffic": [HEAD_ON],
    "bridge": {**TIMES, "lost_link_after_s": 6},
    "simulation": {"limit_s": 300, "bridge_faults": {"seed": 1, "cut_s": 36}},
}
RETURNS = {
    "link_loss": {
        "choice": "return",
        "after_s": 4,
        "to": {"name": "field", "position": {"north_m": 300, "east_m": 700, "alt_m": 320}},
    },
    "bridge": TIMES,
    "simulation": {"limit_s": 300, "bridge_faults": {"seed": 1, "cut_s": 20}},
}


@pytest.mark.long
@pytest.mark.parametrize(
    ("more", "modes", "g4"),
    [(IN_HAND, ["Loiter"], "violated"), (RETURNS, ["Return", "Over"], "holds")],
    ids=["in the hand of ICAROUS", "return"],
)
def test_it_ends_in_the_safe_state(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    more: dict[str, Any],
    modes: list[str],
    g4: str,
) -> None:
    # UxAS, which hears no ICAROUS, has nothing to tell for longer than this
    monkeypatch.setattr(flight, "SILENCE_S", 6.0)
    text = {
        "name": "lost",
        "frame": {"latitude_deg": 37.1, "longitude_deg": -76.4, "terrain_m": 0},
        "vehicles": [VEHICLE],
        "tasks": [POINT],
        "daa": {"well_clear": {"dthr_m": 150, "zthr_m": 30, "tthr_s": 15, "tcoa_s": 0}},
        **more,
    }
    file = tmp_path / "lost.yaml"
    file.write_text(yaml.safe_dump(text))
    out = tmp_path / "out"
    assert main(["run", str(file), "--processes", "--rate", "3", "--out", str(out)]) == 1
    (path,) = out.rglob("report.json")
    report = json.loads(path.read_text())
    assert report["flight"]["outcome"] == "safe state"
    (end,) = report["flight"]["served"]
    assert end["phase"] == "Failed"
    assert "vehicle 1 circles without the link since" in end["note"]
    rows = {row["item"]: row["verdict"] for row in report["constraints"]}
    assert rows[CIRCLE] == "holds"
    assert rows.get(ALONE) == ("holds" if "link_loss" in more else None)
    verdicts = {row["requirement"]: row["verdict"] for row in report["requirements"]}
    assert (verdicts["G3"], verdicts["G4"]) == ("violated", g4)
    events = [one["text"] for one in report["flight"]["events"]]
    said = [text for text in events if text.startswith("without the link: ")]
    assert len(said) == len(modes), events
    capsys.readouterr()
    assert main(["judge", str(path.parent), "--json"]) == 1
    judged = {row["item"]: row["verdict"] for row in json.loads(capsys.readouterr().out)["rows"]}
    assert judged[CIRCLE] == "holds"
