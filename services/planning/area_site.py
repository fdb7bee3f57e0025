"""Data shared by all paths over one area: the area, the vehicle class, and the swath of a pass."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from cratous.core.tasks.coverage import outline, square_array, square_side_m
from cratous.core.tasks.sweep import Piece, Swath, SwathOf, swath, unjoined_m
from cratous.services.mission.sensor import footprints, looks_over
from cratous.services.planning.performance_classes import Flyer
from cratous.services.planning.smoothing import MARGIN
from cratous.spec.mission import Camera, Task, View

GLANCE_S = 2.0
"""Least time for which each part of a swath stays in view [s], so that nothing is missed between frames."""


class Candidate(NamedTuple):
    """A path over an area without its turns, and its length [m]."""

    label: str
    pieces: tuple[Piece, ...]
    length_m: float
    view: View | None


class Site(NamedTuple):
    """Data shared by all paths of one class of vehicles over one area."""

    task: Task
    flyer: Flyer
    camera: Camera
    height_m: float
    vertices: tuple[tuple[float, float], ...]
    side_m: float
    squares: Callable[[], Any]


def site_of(task: Task, flyer: Flyer, camera: Camera, terrain_m: float) -> Site:
    """The site of a task for a class of vehicles with a camera, above flat terrain [m MSL]."""
    vertices = outline(task)
    side_m = square_side_m(vertices)
    squares = functools.cache(functools.partial(square_array, vertices, side_m))
    return Site(task, flyer, camera, flyer.alt_m - terrain_m, vertices, side_m, squares)


def candidate_of(
    site: Site, label: str, pieces: Sequence[Piece], view: View | None = None
) -> Candidate:
    """A candidate from these pieces, with its length if no zone obstructs its turns."""
    return Candidate(label, tuple(pieces), unjoined_m(pieces, site.flyer.radius_m), view)


def lane_width_m(swath_of: SwathOf, heading_rad: float) -> float:
    """Lane width for a heading, flown in both directions [m]; 0 if no swath exists."""
    seen = [swath_of(h) for h in (heading_rad, heading_rad + math.pi)]
    return max(0.0, min((s.width_m if s is not None else 0.0) for s in seen))


def swaths_of(site: Site, view: View | None) -> SwathOf:
    """The swath by heading, narrowed by one square on each side so that squares at the seams are covered."""
    least_m = GLANCE_S * site.flyer.speed_m_s + site.side_m
    return functools.partial(_swath, site.camera, view, site.height_m, site.side_m, least_m)


@functools.lru_cache(maxsize=4096)
def _swath(
    camera: Camera,
    view: View | None,
    height_m: float,
    side_m: float,
    least_m: float,
    heading_rad: float,
) -> Swath | None:
    """Cached, since vehicle classes and successive plans ask for the same swaths."""
    import numpy as np

    step = np.array([[math.cos(heading_rad), math.sin(heading_rad)]])
    looks = looks_over(np.vstack([0 * step, step]), view, height_m)
    corners = footprints(looks, height_m, camera, MARGIN)[0]
    if np.isnan(corners[0, 0]):
        return None
    found = swath(_corners(corners), heading_rad, least_m)
    if found is None:
        return None
    half = side_m / 2
    return Swath(
        found.left_m + half, found.right_m - half, found.near_m + side_m, found.far_m - side_m
    )


def _corners(array: Any) -> list[tuple[float, float]]:
    return [(float(north), float(east)) for north, east in array]
