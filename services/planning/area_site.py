"""Data shared by all paths over one area: the area, the vehicle class, and the swath of a pass."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.tasks.coverage import area_m2, outline, square_array, square_side_m
from cratous.core.tasks.stations import in_ring
from cratous.core.tasks.sweep import LANES_MOST, Piece, Swath, SwathOf, swath, unjoined_m
from cratous.services.mission.sensor import footprints, looks_over, sample_distance_m, zoomed
from cratous.services.planning.area_views import open_view
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


def swaths_aside(site: Site) -> Callable[[float, View], Swath | None]:
    """The swath of a pass along a heading [rad] with a view that is fixed over ground; the same, but for its last
    digits, for every heading at the same angle to the view, and so computed once.
    """
    known: dict[tuple[float, float], Swath | None] = {}

    def found(heading_rad: float, view: View) -> Swath | None:
        aside_rad = round((view.azimuth_rad - heading_rad) % (2 * math.pi), 9)
        key = (aside_rad, view.elevation_rad)
        if key not in known:
            known[key] = swaths_of(site, replace(view, azimuth_rad=aside_rad))(0.0)
        return known[key]

    return found


def lane_lengths(site: Site, heading_rad: float, lead_m: float) -> Callable[[Swath], float]:
    """The approximate length of parallel lanes over the area with their turns, by their swath [m]; infinite if there
    are too many.

    The lanes are as many as for the whole width, and on average as long as the area's mean chord.
    """
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    across = [e * c - n * s for n, e in site.vertices]
    extent_m = max(across) - min(across)
    chord_m = area_m2(site.vertices) / extent_m

    def length_m(seen: Swath) -> float:
        if not in_ring(Vec2(extent_m, 0.0), Vec2(0.0, 0.0), 0.0, seen.width_m * LANES_MOST):
            return math.inf
        settled_m = max(chord_m + seen.near_m - seen.far_m + 1.2 * lead_m, lead_m)
        return math.ceil(extent_m / seen.width_m) * (settled_m + math.pi * site.flyer.radius_m)

    return length_m


def swaths_of(site: Site, view: View | None) -> SwathOf:
    """The swath by heading, narrowed by one square on each side so that squares at the seams are covered."""
    least_m = GLANCE_S * site.flyer.speed_m_s + site.side_m
    camera = camera_with(site, view)
    return functools.partial(_swath, camera, view, site.height_m, site.side_m, least_m)


def camera_with(site: Site, view: View | None) -> Camera:
    """The camera as it is zoomed for a view."""
    return zoomed(site.camera, site.task, site.height_m, view if open_view(site.task) else None)


def tilt_label(site: Site, view: View | None) -> str:
    """What the planner's own view adds to a label: its tilt and, if the task requires a ground sample distance, the one
    along the view, which is coarser than the one across it.
    """
    if view is None:
        return ""
    text = f", {round(-math.degrees(view.elevation_rad))} deg down"
    camera = camera_with(site, view)
    if not (max(site.task.gsd_m, 0.0) and camera.pixels):
        return text
    along_m = sample_distance_m(camera, view, site.height_m) / math.sin(-view.elevation_rad)
    return f"{text}, {along_m:.2g} m a pixel along the view"


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
