"""Where the camera looks while a task is flown, consistent with its planned option."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from cratous.services.mission.sensor import aim, look_on_line
from cratous.services.planning.area_views import brought_view, open_view
from cratous.services.planning.performance_classes import camera_for
from cratous.services.planning.point_paths import tilted
from cratous.spec.mission import AREAS, Camera, Position, Task, TaskKind, View


class Angles(NamedTuple):
    """The view for which an option was made [rad]; elevation None: no view."""

    elevation_rad: float | None
    azimuth_rad: float


def chosen_view(task: Task, made_for: Angles) -> View | None:
    """The wanted view for which the option was made: of several, the one closest to its angles."""
    if made_for.elevation_rad is None or not task.views:
        return task.view
    return _nearest(made_for.elevation_rad, made_for.azimuth_rad, (task.view, *task.views))


def flown_view(task: Task, made_for: Angles, cameras: Sequence[Camera]) -> View | None:
    """As `chosen_view`; if the task requires no view, the one chosen by the planner for the option."""
    asked = chosen_view(task, made_for)
    if open_view(task):
        return brought_view(task, *made_for)
    brought = tilted(task, camera_for(task, cameras))
    if asked is not None or made_for.elevation_rad is None or not brought:
        return asked
    return _nearest(made_for.elevation_rad, made_for.azimuth_rad, brought)


def _nearest(elevation_rad: float, azimuth_rad: float, views: Iterable[View | None]) -> View | None:
    """The view closest to these angles; None counts as straight down."""

    def off(view: View | None) -> float:
        if view is None:
            return abs(elevation_rad + math.pi / 2)
        turn = math.remainder(view.azimuth_rad - azimuth_rad, 2 * math.pi)
        return abs(view.elevation_rad - elevation_rad) + abs(turn)

    return min(views, key=off)


def target_from(
    here: Position,
    heading_rad: float,
    task: Task,
    made_for: Angles,
    cameras: Sequence[Camera],
    terrain_m: float,
) -> Position | None:
    """The ground point to look at from a place; None for a task that looks at nothing.

    For a line: its point nearest to where the view of the flown option looks, as in planning; for a point:
    the point; over an area: below the aircraft or where the view looks.
    """
    if not task.points:
        return None
    height_m = here.alt_m - terrain_m
    if task.kind is TaskKind.LINE_SEARCH:
        view = flown_view(task, made_for, cameras)
        n, e = look_on_line(here[:2], heading_rad, task.points, view, height_m)
        return Position(n, e, terrain_m)
    if task.kind is TaskKind.POINT_SEARCH:
        return task.points[0]
    if task.kind in AREAS:
        view = flown_view(task, made_for, cameras)
        n, e = aim(here.north_m, here.east_m, heading_rad, view, height_m)
        return Position(float(n), float(e), terrain_m)
    return None
