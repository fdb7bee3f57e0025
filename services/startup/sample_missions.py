"""Small missions that represent larger ones: a route around a zone, lanes with turns, footprints along a
line.

Together they call every loop that planning compiles.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission

_HEAD = """
name: little
frame: {latitude_deg: 45, longitude_deg: -120}
vehicles:
  - id: 1
    position: {north_m: 0, east_m: 0, alt_m: 300}
    heading_deg: 0
    speed_m_s: 20
    min_speed_m_s: 15
    max_speed_m_s: 30
    max_bank_deg: 30
    max_climb_m_s: 3
    cameras: [{payload_id: 1, hfov_deg: 45, pixels: 1000}]
"""
_ZONE = """
zones:
  - id: 1
    kind: keep_out
    vertices: [[1000, -200], [1000, 200], [1200, 200], [1200, -200]]
"""
TASKS = (
    "kind: point_search, points: [{north_m: 4500, east_m: 0}]",
    "kind: line_search, points: [{north_m: 3000, east_m: 0}, {north_m: 3500, east_m: 300}, "
    "{north_m: 4000, east_m: 0}]",
    "kind: area_search, rectangle: {centre: {north_m: 2000, east_m: 0}, width_m: 600, height_m: 500}",
    "kind: must_fly, points: [{north_m: 5000, east_m: 0, alt_m: 300}]",
)
"""One task of each kind, without its id."""


def mission(tasks: Sequence[str], zone: str = _ZONE) -> Mission:
    """A mission of one vehicle, an optional zone, and these tasks, each as in `TASKS`."""
    lines = (f"  - {{id: {number}, {task}}}\n" for number, task in enumerate(tasks, 1))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mission.yaml"
        file.write_text(f"{_HEAD}{zone}tasks:\n{''.join(lines)}", encoding="utf-8")
        made = load(file)
    assert isinstance(made, Mission)
    return made


def plan(tasks: Sequence[str], zone: str = _ZONE) -> None:
    """Plan such a mission."""
    make_plan(mission(tasks, zone))
