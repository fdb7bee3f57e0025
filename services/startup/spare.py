"""What a process that has nothing to do yet does for its first request: reads compiled loops, and plans a little.

Each piece is short, so that a request which comes meanwhile waits for no more than it would have taken itself.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from cratous.core.geofence.mission_leg_arrays import first_bad
from cratous.core.readings.tiered import SOON, swift
from cratous.core.routing.bulk import direct_many, route_many, route_points
from cratous.core.routing.dubins_words import legs, legs_length, words
from cratous.core.tasks.coverage_arrays import grid_squares, mark_seen
from cratous.core.tasks.footprints import nearest_on_line, points_in_quads
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan

_LOOPS: tuple[Callable[..., Any], ...] = (
    words, legs, legs_length, route_points, direct_many, route_many, first_bad, grid_squares, mark_seen,
    nearest_on_line, points_in_quads,
)  # fmt: skip
_HEAD = """
name: before_the_first_request
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
zones:
  - id: 1
    kind: keep_out
    vertices: [[1000, -200], [1000, 200], [1200, 200], [1200, -200]]
tasks:
"""
_TASKS = (
    "{kind: point_search, points: [{north_m: 4500, east_m: 0}]}",
    "{kind: line_search, points: [{north_m: 3000, east_m: 0}, {north_m: 3500, east_m: 300}, "
    "{north_m: 4000, east_m: 0}]}",
    "{kind: area_search, rectangle: {centre: {north_m: 2000, east_m: 0}, width_m: 600, height_m: 500}}",
    "{kind: must_fly, points: [{north_m: 5000, east_m: 0, alt_m: 300}]}",
)


def pieces() -> Iterator[None]:
    """Small missions, planned one by one; each is planned when the next one is asked for."""
    for loop in _LOOPS:
        swift(loop, SOON + 1)  # as if it had done much: it is read, if it is kept
        yield
    for chosen in (*((task,) for task in _TASKS), _TASKS):
        lines = (f"  - {{id: {n}, {text[1:]}" for n, text in enumerate(chosen, 1))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mission.yaml"
            file.write_text(_HEAD + "\n".join(lines) + "\n", encoding="utf-8")
            make_plan(load(file))
        yield
