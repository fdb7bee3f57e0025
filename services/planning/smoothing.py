"""From a line to a flyable path from which the camera covers the line.

The line is low-pass filtered, moved to where the wanted view looks at it, and flown as Dubins paths between
poses on it, so that every candidate is flyable. Of the candidates, from the smoothest to the closest, the
first that covers the line is taken.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from cratous.core.routing.dubins import cut, dubins, polyline_length_m
from cratous.services.mission.sensor import SAMPLE_M, covered_by, sample_line, view_distance_m
from cratous.spec.mission import Camera, Position, Task, View
from cratous.spec.mission.plan import Pose

if TYPE_CHECKING:
    import numpy as np

ENOUGH = 0.99
"""Fraction of a line that has to be covered."""
MARGIN = 0.9
"""Planning uses this part of the field of view only, as a margin for tracking errors."""
COLLINEAR_M = 1e-3
"""A point this close to the leg between its neighbours is not a corner [m]."""
WIDTHS = (6.0, 4.5, 3.5, 2.5, 1.75, 1.25, 0.8, 0.5, 0.25, 0.0)
"""Widths of the low-pass filter that are tried, in turn radii."""


class LinePath(NamedTuple):
    """A flyable path along a line: end poses, polyline, fraction of the line covered (or None)."""

    start: Pose
    end: Pose
    points: tuple[Position, ...]
    length_m: float
    coverage: float | None


def low_pass(points: np.ndarray, width_m: float, step_m: float) -> np.ndarray:
    """Points convolved with a Gaussian of standard deviation width_m / 2; the ends stay in place."""
    import numpy as np

    sigma = width_m / 2 / step_m
    if sigma < 0.5 or len(points) < 3:
        return points
    reach = min(len(points) - 1, math.ceil(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    first, last = points[0], points[-1]
    before = 2 * first - points[reach:0:-1]
    after = 2 * last - points[-2 : -reach - 2 : -1]
    extended = np.vstack([before, points, after])
    return np.column_stack([np.convolve(extended[:, k], weights, "valid") for k in (0, 1)])


def offset(
    line: np.ndarray, headings: np.ndarray, view: View | None, height_m: float
) -> np.ndarray:
    """Where to fly so that the wanted view looks at each point of the line."""
    import numpy as np

    if view is None:
        return line
    look = view.azimuth_rad + (0.0 if view.inertial else headings)
    away = view_distance_m(view, height_m)
    return line - away * np.column_stack([np.cos(look) + 0 * headings, np.sin(look) + 0 * headings])


def headings_of(points: np.ndarray) -> np.ndarray:
    """Heading along a polyline at each of its points [rad]."""
    import numpy as np

    steps = np.gradient(points, axis=0)
    return np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))


def fly(
    track: np.ndarray, radius_m: float, alt_m: float, step_m: float
) -> tuple[Pose, Pose, tuple[Position, ...], float]:
    """Dubins paths along a track: end poses, polyline, its length [m].

    A pose that would require a loop is skipped in favour of a later one where that is shorter.
    """
    headings = headings_of(track)
    stride = max(1, round(1.2 * radius_m / step_m))
    last = len(track) - 1
    knots = [*range(0, max(1, last - stride // 2), stride), last]
    poses = [Pose(float(track[k, 0]), float(track[k, 1]), alt_m, float(headings[k])) for k in knots]
    points, i = [Position(*poses[0][:3])], 0
    while i < len(knots) - 1:
        options = []
        for j in range(i + 1, min(i + 5, len(knots))):
            path = dubins(poses[i], poses[j], radius_m)
            along = (knots[j] - knots[i]) * step_m
            options.append((path.length_m / along, j, path))
            if path.length_m <= 1.1 * along:
                break
        _, j, path = min(options, key=lambda option: option[0])
        points.extend(cut(path, poses[j])[1:])
        i = j
    flown = without_collinear(points)
    return poses[0], poses[-1], flown, polyline_length_m(flown)


def without_collinear(points: list[Position]) -> tuple[Position, ...]:
    """The polyline without inner points that lie on the straight leg between their neighbours."""
    kept = points[:1]
    for point, after in pairwise(points[1:]):
        ahead = (after.north_m - kept[-1].north_m, after.east_m - kept[-1].east_m)
        side = (point.north_m - kept[-1].north_m, point.east_m - kept[-1].east_m)
        if abs(ahead[0] * side[1] - ahead[1] * side[0]) > COLLINEAR_M * math.hypot(*ahead):
            kept.append(point)
    return (*kept, points[-1])


def line_path(
    task: Task, camera: Camera | None, radius_m: float, alt_m: float, terrain_m: float
) -> LinePath:
    """The first candidate that covers the line; otherwise the one with the best coverage.

    Without a camera the line itself is flown as closely as the turn radius allows.
    """
    line = sample_line(task.points)
    step = float(math.dist(line[0], line[1])) or SAMPLE_M
    best: LinePath | None = None
    for width in WIDTHS if camera is not None else (0.5,):
        smooth = low_pass(line, width * radius_m, step)
        there = offset(smooth, headings_of(smooth), task.view, alt_m - terrain_m)
        track = low_pass(there, width * radius_m, step)
        start, end, points, total = fly(track, radius_m, alt_m, step)
        if camera is None:
            return LinePath(start, end, points, total, None)
        coarse = float(covered_by(points, task, camera, terrain_m, MARGIN, 8).mean())
        if coarse < ENOUGH and best is not None and coarse <= (best.coverage or 0.0):
            continue
        seen = float(covered_by(points, task, camera, terrain_m, MARGIN).mean())
        found = LinePath(start, end, points, total, seen)
        if seen >= ENOUGH:
            return found
        if best is None or seen > (best.coverage or 0.0):
            best = found
    assert best is not None
    return best
