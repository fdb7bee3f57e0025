"""One mission, flown in one process in virtual time and in processes against the clock: the same decisions."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.services.cli import main

HEARTBEAT_S = 0.5
"""Between two states of the simulator, with each of which comes a heartbeat of an instance; all times are within one."""
STEP_S = 1 / 30
"""Of the simulator's motion: a state is up to a step older than it says."""
RATE = "1"
VEHICLE: dict[str, Any] = {
    "id": 1, "position": {"north_m": 0, "east_m": 0, "alt_m": 300}, "heading_deg": 0, "speed_m_s": 22,
    "min_speed_m_s": 15, "max_speed_m_s": 33, "max_bank_deg": 30, "max_climb_m_s": 5,
    "cameras": [{"payload_id": 1, "hfov_deg": 45}],
}  # fmt: skip
SEARCH = {
    "id": 1, "kind": "line_search", "points": [{"north_m": 900, "east_m": 0}, {"north_m": 4500, "east_m": 0}],
    "view": {"azimuth_deg": 0, "elevation_deg": -90},
}  # fmt: skip
ON_ITS_WAY = {"id": 1, "kind": "must_fly", "points": [{"north_m": 4000, "east_m": 0, "alt_m": 300}]}


def aircraft(number: int, north: float, east: float, v_north: float, v_east: float) -> Any:
    """One that flies straight on."""
    place = {"north_m": north, "east_m": east, "alt_m": 300}
    return {"id": number, "position": place, "velocity": {"north_m_s": v_north, "east_m_s": v_east}}


MISSIONS: dict[str, tuple[dict[str, Any], list[Any]]] = {
    "on the way to a task": (ON_ITS_WAY, [aircraft(9, 5000, 60, -24, 0)]),
    "in a task": (SEARCH, [aircraft(9, 2860, -2600, 0, 20)]),
}


def decisions(
    folder: Path,
) -> tuple[list[tuple[int, str, int]], list[float], list[tuple[Any, ...]]]:
    """Who got which vehicle in which epoch, when [s], and what became of each task when, of a flight."""
    (file,) = folder.rglob("report.json")
    flight = json.loads(file.read_text())["flight"]
    changes = [(one["vehicle"], one["owner"], one["epoch"]) for one in flight["authority"]]
    times = [one["time_ms"] / 1000 for one in flight["authority"]]
    served = [(one["task"], one["vehicle"], one["phase"]) for one in flight["served"]]
    return changes, [*times, *(one["time_ms"] / 1000 for one in flight["served"])], served


@pytest.mark.long
@pytest.mark.parametrize("name", MISSIONS)
def test_the_same_takeovers_handbacks_epochs_and_tasks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    task, others = MISSIONS[name]
    text = {
        "name": "same",
        "frame": {"latitude_deg": 37.1, "longitude_deg": -76.4, "terrain_m": 0},
        "vehicles": [VEHICLE],
        "tasks": [task],
        "traffic": others,
        "daa": {"well_clear": {"dthr_m": 150, "zthr_m": 30, "tthr_s": 15, "tcoa_s": 0}},
    }
    file = tmp_path / "same.yaml"
    file.write_text(yaml.safe_dump(text))
    words = ["run", str(file), "--quiet", "--allow-unproved", "--out"]
    main([*words, str(tmp_path / "virtual")])
    main([*words, str(tmp_path / "processes"), "--processes", "--rate", RATE])
    said = capsys.readouterr().out
    virtual, real = decisions(tmp_path / "virtual"), decisions(tmp_path / "processes")
    assert virtual[0], "ICAROUS takes the vehicle"
    assert virtual[0] == real[0], said
    assert virtual[2] == real[2], said
    for k, (expected_s, got_s) in enumerate(zip(virtual[1], real[1], strict=True)):
        within_s = HEARTBEAT_S + STEP_S
        assert got_s == pytest.approx(expected_s, abs=within_s), (k, virtual[1], real[1])
