"""A trace in which nothing came that a requirement could be asked of: it is unknown, and its signal is listed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cratous.services.cli import main
from cratous.services.logs.store import LogStore

OWN = """trace every 500 ms gap 1 s
signal z: m from AirVehicleState[ID=999].Location.Altitude hold 1 s
requirement FLOOR: z >= 90 m
requirement BACK: z < 90 m implies eventually within 10 s z >= 90 m
"""


def test_what_no_sample_was_asked_of_is_unknown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with LogStore(tmp_path / "log.sqlite"):
        pass
    (tmp_path / "own.req").write_text(OWN)
    words = ["monitor", str(tmp_path / "log.sqlite"), "--requirements", str(tmp_path / "own.req")]
    assert main([*words, "--json", "--allow-unproved"]) == 3
    found = json.loads(capsys.readouterr().out)
    assert {row["name"]: row["verdict"] for row in found["requirements"]} == {
        "FLOOR": "unknown", "BACK": "unknown",
    }  # fmt: skip
    assert ("never", "z") in [(one["kind"], one["signal"]) for one in found["findings"]]
