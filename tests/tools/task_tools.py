"""A vehicle, tasks of each kind and small missions of one task, as the tests of tasks share them."""

from __future__ import annotations

import math
from typing import Any

from mission_tools import plain_mission

from cratous.services.planning.options import expand
from cratous.spec.mission import (
    Camera,
    Frame,
    Mission,
    Pattern,
    Position,
    Task,
    TaskKind,
    Vehicle,
    Zone,
    ZoneKind,
)

FIELD = ((0.0, 0.0), (900.0, -200.0), (1300.0, 600.0), (700.0, 1100.0), (-100.0, 700.0))
ELL = ((0.0, 0.0), (0.0, 300.0), (100.0, 300.0), (100.0, 100.0), (300.0, 100.0), (300.0, 0.0))


def vehicle(cameras: tuple[Camera, ...] = (Camera(),), alt: float = 400.0) -> Vehicle:
    at = Position(-1500.0, 0.0, alt)
    return Vehicle(1, "", at, 0.0, 25.0, 18.0, 33.0, math.radians(35), 5.0, True, cameras)


def area(corners: Any = FIELD, **more: Any) -> Task:
    points = tuple(Position(n, e, 0.0) for n, e in corners)
    return Task(1, TaskKind.AREA_SEARCH, "", points, **more)


def pattern(kind: Pattern, extent: float = 700.0) -> Task:
    at = (Position(500.0, 300.0, 0.0),)
    return Task(1, TaskKind.PATTERN_SEARCH, "", at, pattern=kind, extent_m=extent)


def point(**more: Any) -> Task:
    return Task(1, TaskKind.POINT_SEARCH, "", (Position(500.0, 300.0, 0.0),), **more)


def mission(task: Task, who: Vehicle | None = None, zones: tuple[Zone, ...] = ()) -> Mission:
    frame = Frame(45.0, -120.0)
    return plain_mission((who or vehicle(),), (task,), source="m.yaml", frame=frame, zones=zones)


def options(task: Task, who: Vehicle | None = None, zones: tuple[Zone, ...] = ()) -> Any:
    of = mission(task, who, zones)
    return expand(of, of.tasks, zones)


def keep_out(south: float, west: float, north: float, east: float) -> Zone:
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(7, ZoneKind.KEEP_OUT, corners, -100.0, 5000.0)
