"""Camera coverage of flat ground: footprints, and how much of a line a flight covers.

A gimbal points the boresight at a target as far as its limits allow; the footprint is the quadrilateral in
which the image's four corner rays meet the ground. The kernel `locate` decides whether a point lies in a
footprint; numpy only computes the candidate footprints.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.core.geofence.planar import edges_of, locate
from cratous.core.kernel import Vec2
from cratous.core.readings.tiered import swift
from cratous.core.tasks.footprints import nearest_on_line, points_in_quads
from cratous.services.mission.required_views import FLATTEST_RAD, near_asked
from cratous.spec.mission import Camera, Position, Task, View

if TYPE_CHECKING:
    import numpy as np

SAMPLE_M = 10.0
"""Spacing of the points at which a line's coverage is checked [m]."""

Quad = tuple[tuple[float, float], ...]


class Look(NamedTuple):
    """Camera position, aircraft heading [rad] and ground target (north, east) [m]."""

    north_m: float
    east_m: float
    heading_rad: float
    target_north_m: float
    target_east_m: float


def footprints(
    looks: np.ndarray | Sequence[Look],
    height_m: float,
    camera: Camera,
    shrink: float = 1.0,
    flattest_rad: float = FLATTEST_RAD,
) -> np.ndarray:
    """Footprint corners of many looks, shape (n, 4, 2) as north, east; NaN where there is none.

    height_m: above ground, > 0; shrink: factor on the tangents of the half field of view, below 1 to keep a
    margin. There is no footprint if a corner ray does not meet the ground, or at an angle flatter than
    `flattest_rad`.
    """
    import numpy as np

    data = np.asarray(looks, float).reshape(-1, 5)
    dn, de = data[:, 3] - data[:, 0], data[:, 4] - data[:, 1]
    distance = np.hypot(dn, de)
    bearing = np.where(distance > 1e-6, np.arctan2(de, dn), data[:, 2])
    azimuth = np.remainder(bearing - data[:, 2] + np.pi, 2 * np.pi) - np.pi
    azimuth = np.clip(azimuth, camera.min_azimuth_rad, camera.max_azimuth_rad)
    elevation = -np.arctan2(height_m, distance)
    elevation = np.clip(elevation, camera.min_elevation_rad, camera.max_elevation_rad)
    look = data[:, 2] + azimuth
    half = math.tan(camera.hfov_rad / 2) * shrink
    level, below = np.cos(elevation), np.sin(elevation)
    north, east = np.cos(look), np.sin(look)
    flattest = math.tan(flattest_rad)
    corners = np.full((len(data), 4, 2), np.nan)
    for k, (right, up) in enumerate(((-1, 1), (1, 1), (1, -1), (-1, -1))):
        # corner ray: boresight + right * half * (right axis) + up * half / aspect * (up axis)
        r, u = right * half, up * half / camera.aspect
        ahead = level - u * below
        down = -(below + u * level)
        steep = (down > 1e-3) & (down >= flattest * np.hypot(ahead, r))
        reach = np.where(steep, height_m / np.where(steep, down, 1.0), np.nan)
        corners[:, k, 0] = data[:, 0] + reach * (ahead * north - r * east)
        corners[:, k, 1] = data[:, 1] + reach * (ahead * east + r * north)
    corners[np.isnan(corners).any(axis=(1, 2))] = np.nan
    return corners


def footprint(
    position: Position,
    heading_rad: float,
    camera: Camera,
    target: tuple[float, float],
    terrain_m: float = 0.0,
) -> Quad | None:
    """The quadrilateral on the ground (north, east) that the camera sees, or None."""
    look = Look(position.north_m, position.east_m, heading_rad, *target)
    height = position.alt_m - terrain_m
    if height <= 0:
        return None
    corners = footprints([look], height, camera)[0]
    if corners[0, 0] != corners[0, 0]:
        return None
    return tuple((float(n), float(e)) for n, e in corners)


def sees(quad: Quad, point: tuple[float, float]) -> bool:
    """Whether the ground point lies in the footprint or on its edge (kernel `locate`)."""
    return bool(locate(edges_of(quad), Vec2(*point)) >= 0)


def sample_line(points: Sequence[Position], step_m: float = SAMPLE_M) -> np.ndarray:
    """Points (north, east) along a polyline at most step_m apart, both ends included."""
    import numpy as np

    corners = np.array([(p.north_m, p.east_m) for p in points])
    gaps = np.hypot(*np.diff(corners, axis=0).T)
    along = np.concatenate(([0.0], np.cumsum(gaps)))
    count = max(2, math.ceil(along[-1] / step_m) + 1)
    at = np.linspace(0.0, along[-1], count)
    return np.column_stack([np.interp(at, along, corners[:, k]) for k in (0, 1)])


def covered(
    line: np.ndarray,
    looks: np.ndarray | Sequence[Look],
    height_m: float,
    camera: Camera,
    shrink: float = 1.0,
) -> np.ndarray:
    """Which of the sampled points of a line lie in at least one of the footprints."""
    import numpy as np

    quads = footprints(looks, height_m, camera, shrink) if height_m > 0 and len(looks) else None
    seen = np.zeros(len(line), bool)
    if quads is None:
        return seen
    quads = quads[~np.isnan(quads[:, 0, 0])]
    if len(quads) == 0:
        return seen
    swift(points_in_quads, len(line) * len(quads) // 100)(
        np.ascontiguousarray(line), np.ascontiguousarray(quads), seen
    )
    return seen


def looks_of(
    places: np.ndarray, line: np.ndarray, view: View | None, height_m: float
) -> np.ndarray:
    """The gimbal's targets from each place (north, east) along a flight.

    The point of the line nearest to where the required view looks; without a required view, nearest to the
    place itself.
    """
    import numpy as np

    steps = np.gradient(places, axis=0)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    wanted = places
    if view is not None:
        away = view_distance_m(view, height_m)
        bearing = view.azimuth_rad + (0.0 if view.inertial else 1.0) * heading
        wanted = places + away * np.column_stack([np.cos(bearing), np.sin(bearing)])
    points = np.ascontiguousarray(line[::2])
    apart = float(np.hypot(*np.diff(points, axis=0).T).max()) if len(points) > 1 else 0.0
    at = np.empty(len(wanted), np.int64)
    swift(nearest_on_line, len(wanted))(np.ascontiguousarray(wanted), points, apart, at)
    return np.column_stack([places, heading, points[at]])


def look_on_line(
    here: tuple[float, float],
    heading_rad: float,
    points: tuple[Position, ...],
    view: View | None,
    height_m: float,
) -> tuple[float, float]:
    """The gimbal's target from one place (north, east): as `looks_of` for a whole flight."""
    import numpy as np

    wanted = aim(*here, heading_rad, view, max(height_m, 0.0))
    line = _sampled(points)[::2]
    n, e = line[int(np.argmin(((line - np.array(wanted)) ** 2).sum(axis=1)))]
    return float(n), float(e)


@lru_cache(maxsize=64)
def _sampled(points: tuple[Position, ...]) -> Any:
    return sample_line(points)


def looks_over(places: np.ndarray, view: View | None, height_m: float) -> np.ndarray:
    """The gimbal's targets over an area: straight down, or as the required view looks.

    places: north, east along a flight, two or more; one look each.
    """
    import numpy as np

    steps = np.gradient(places, axis=0)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    n, e = aim(places[:, 0], places[:, 1], heading, view, height_m)
    return np.column_stack([places, heading, n, e])


def aim(north_m: Any, east_m: Any, heading_rad: Any, view: View | None, height_m: float) -> Any:
    """The ground point (north, east) that a view looks at from a place; the place itself without a view."""
    import numpy as np

    if view is None:
        return north_m, east_m
    away = view_distance_m(view, height_m)
    bearing = view.azimuth_rad + (0.0 if view.inertial else 1.0) * heading_rad
    return north_m + away * np.cos(bearing), east_m + away * np.sin(bearing)


def elevation_rad(camera: Camera, view: View | None) -> float:
    """Camera elevation for a view; without one, as close to straight down as the gimbal allows [rad]."""
    wanted = view.elevation_rad if view is not None else -math.pi / 2
    return max(camera.min_elevation_rad, min(camera.max_elevation_rad, wanted))


def sample_distance_m(camera: Camera, view: View | None, height_m: float) -> float:
    """Ground sample distance across the centre of the image [m/pixel]; pixels must be known."""
    slant = height_m / math.sin(-elevation_rad(camera, view))
    return 2 * slant * math.tan(camera.hfov_rad / 2) / camera.pixels


def zoomed(camera: Camera, task: Task, height_m: float, brought: View | None = None) -> Camera:
    """The camera zoomed in just enough for the task's ground sample distance.

    brought: the planner's view, where the task leaves that open. Unchanged where the distance is met already, cannot
    be reached, or is unknown.
    """
    if task.gsd_m <= 0 or camera.pixels == 0 or not camera.zoom_rad or height_m <= 0:
        return camera
    slants = [
        height_m / max(math.sin(-elevation_rad(camera, view)), 1e-6)
        for view in ((task.view, *task.views) if brought is None else (brought,))
    ]
    widest = 2 * math.atan(task.gsd_m * (1 - 1e-9) * camera.pixels / (2 * max(slants)))
    fits = [field for field in (camera.hfov_rad, *camera.zoom_rad) if field <= widest]
    if camera.zooms and min(camera.zoom_rad) <= widest <= camera.hfov_rad:
        fits.append(widest)
    return replace(camera, hfov_rad=max(fits)) if fits else camera


def view_distance_m(view: View | None, height_m: float) -> float:
    """Horizontal distance from which the sensor looks at its target [m]; 0 if no view angle is required."""
    if view is None or view.elevation_rad <= -math.pi / 2 + 1e-6:
        return 0.0
    return height_m / math.tan(-view.elevation_rad)


def covered_by(
    path: Sequence[Position],
    task: Task,
    camera: Camera,
    terrain_m: float,
    shrink: float = 1.0,
    every: int = 1,
) -> np.ndarray:
    """Which points of the task's line (or its one point) a flight along the path sees. every: check only
    every n-th point.
    """
    import numpy as np

    line = sample_line(task.points) if len(task.points) > 1 else np.array([task.points[0][:2]])
    height = min(p.alt_m for p in path) - terrain_m
    places = sample_line(path, max(10.0, height / 15))
    looks = looks_of(places, line, task.view, height)
    looks = looks[near_asked(looks, height, task, camera)]
    return covered(line[::every], looks, height, camera, shrink)


def coverage(path: Sequence[Position], task: Task, camera: Camera, terrain_m: float = 0.0) -> float:
    """Fraction of the task's line (sampled every 10 m) that a flight along `path` sees as required.

    path: in the order of flight, two or more points. The gimbal aims as in `looks_of`.
    """
    return float(covered_by(path, task, camera, terrain_m).mean())


def share_seen(
    path: Sequence[Position], task: Task, camera: Camera, terrain_m: float = 0.0
) -> float:
    """Fraction of a path's sample points from which the task's single point is seen."""
    import numpy as np

    point = (task.points[0].north_m, task.points[0].east_m)
    height = min(p.alt_m for p in path) - terrain_m
    if height <= 0:
        return 0.0
    places = sample_line(path, max(10.0, height / 15))
    looks = looks_of(places, np.array([point]), task.view, height)
    asked = near_asked(looks, height, task, camera)
    seen = [
        near
        and not np.isnan(quad[0, 0])
        and sees(tuple((float(n), float(e)) for n, e in quad), point)
        for near, quad in zip(asked.tolist(), footprints(looks, height, camera), strict=True)
    ]
    return sum(seen) / len(seen)
