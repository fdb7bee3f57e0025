"""A flight in processes in which ICAROUS asks UxAS's planner for a way back, over the wire, to its end."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from cratous.services.cli import main

MISSION = """
name: barred
frame: {latitude_deg: 37.1, longitude_deg: -76.4, terrain_m: 0}
vehicles:
  - {id: 2, position: {north_m: 0, east_m: -600, alt_m: 300}, heading_deg: 90, speed_m_s: 22,
     min_speed_m_s: 15, max_speed_m_s: 33, max_bank_deg: 30, max_climb_m_s: 5}
tasks:
  - {id: 2, kind: must_fly, eligible: [2], points: [{north_m: 0, east_m: 200, alt_m: 300}]}
relations: "p2"
daa: {well_clear: {dthr_m: 150, zthr_m: 30, tthr_s: 15, tcoa_s: 0}, lookahead_s: 60}
zones:
  - {id: 1, kind: keep_out, label: school, floor_m: 0, ceiling_m: 1000,
     vertices: [[-600, 600], [-60, 600], [-60, 1500], [-600, 1500]]}
traffic:
  - {id: 9, position: {north_m: 0, east_m: 2400, alt_m: 300}, velocity: {north_m_s: 0, east_m_s: -30}}
bridge: {uxas_route_planner: true}
"""
"""Along the edge of a zone, head-on with somebody who does not give way."""


@pytest.mark.long
def test_each_request_is_answered_and_the_mission_ends(tmp_path: Path) -> None:
    mission, out = tmp_path / "mission.yaml", tmp_path / "out"
    mission.write_text(MISSION)
    words = [
        "run",
        str(mission),
        "--processes",
        "--rate",
        "4",
        "--allow-unproved",
        "--quiet",
        "--out",
        str(out),
    ]
    # a loaded machine may be late with heartbeats, and theorems of a gate on board say nothing here
    assert main(words) in (1, 3)
    report = json.loads((out / "barred/report.json").read_text())
    verdicts = {one["requirement"]: one["verdict"] for one in report["requirements"]}
    assert report["flight"]["outcome"] == "complete"
    assert report["flight"]["takeovers"]
    assert [verdicts[name] for name in ("G1", "G3", "G4")] == ["holds"] * 3
    said = (out / "barred/uxas.txt").read_text()
    asked = re.findall(
        r"vehicle 2: ICAROUS asks for a way back \(request (\d+)\): (\d+) places", said
    )
    assert [int(number) for number, _ in asked] == list(range(1, len(asked) + 1))
    assert asked
    assert all(int(places) for _, places in asked)
    assert "refused: none" in said
