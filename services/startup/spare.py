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
from cratous.services.startup.small_missions import TASKS, mission

_LOOPS: tuple[Callable[..., Any], ...] = (
    words, legs, legs_length, route_points, direct_many, route_many, first_bad, grid_squares, mark_seen,
    nearest_on_line, points_in_quads,
)  # fmt: skip


def pieces() -> Iterator[None]:
    """Small missions, planned one by one; each is planned when the next one is asked for."""
    for loop in _LOOPS:
        swift(loop, SOON + 1)  # as if it had done much: it is read, if it is kept
        yield
    for chosen in (*((task,) for task in TASKS), TASKS):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mission.yaml"
            file.write_text(mission("before_the_first_request", chosen), encoding="utf-8")
            make_plan(load(file))
        yield
