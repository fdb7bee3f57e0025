"""Which camera views count for a search: none near the horizon, and none far from the required view.

A view is judged by where its image lies on the ground, as seen from the point below the aircraft: the centre
of the image within a ring, each corner within a reach. A ring is an interval of elevations, since
tan(elevation) is height over distance. Neither depends on what the camera reports.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from cratous.spec.mission import Camera, Task, View

if TYPE_CHECKING:
    import numpy as np

FLATTEST_RAD = math.radians(5)
"""Smallest depression angle that counts as seen; flatter views are near the horizon [rad]."""
OFF_VIEW_RAD = math.radians(30)
"""Largest difference in elevation between the image centre and the required view [rad]."""
COARSER = 1.01
"""A ground sample distance is met up to this factor of the required one."""


class Ring(NamedTuple):
    """Bounds of a horizontal distance [m]."""

    least_m: float
    most_m: float


def reach_m(height_m: float) -> float:
    """Largest horizontal distance at which an aircraft at a height sees anything [m]."""
    return height_m / math.tan(FLATTEST_RAD)


def rings(task: Task, height_m: float) -> tuple[Ring, ...]:
    """Rings, in one of which the centre of an image must lie. height_m: above the ground, > 0."""
    if task.view is None:
        return (Ring(0.0, reach_m(height_m)),)
    views = (view for view in (task.view, *task.views) if view is not None)
    return tuple(_ring(view, height_m) for view in views)


def _ring(view: View, height_m: float) -> Ring:
    down = abs(view.elevation_rad)
    steepest, flattest = down + OFF_VIEW_RAD, max(down - OFF_VIEW_RAD, FLATTEST_RAD)
    least_m = 0.0 if steepest >= math.pi / 2 else height_m / math.tan(steepest)
    return Ring(least_m, height_m / math.tan(flattest))


def near_asked(looks: np.ndarray, height_m: float, task: Task, camera: Camera) -> np.ndarray:
    """Which planned looks (n, 5), as `sensor.Look`, are close enough to a required view, (n,) bool."""
    import numpy as np

    if task.view is None:
        return np.ones(len(looks), bool)
    away = np.hypot(looks[:, 3] - looks[:, 0], looks[:, 4] - looks[:, 1])
    down = np.clip(np.arctan2(height_m, away), -camera.max_elevation_rad, -camera.min_elevation_rad)
    wanted = [abs(view.elevation_rad) for view in (task.view, *task.views) if view is not None]
    return np.any([np.abs(down - one) <= OFF_VIEW_RAD for one in wanted], axis=0)


def sharp_within_m(task: Task, camera: Camera, hfov_rad: float, height_m: float) -> float:
    """Largest horizontal distance at which the image centre meets the required sample distance [m]; negative:
    nowhere.

    Infinite where no ground sample distance is required, or the camera's pixels are unknown.
    """
    if not max(task.gsd_m, 0.0) or camera.pixels == 0:
        return math.inf
    slant_m = COARSER * task.gsd_m * camera.pixels / (2 * math.tan(hfov_rad / 2))
    squared = slant_m**2 - height_m**2
    return math.copysign(math.sqrt(abs(squared)), squared)


def middle(corners: Sequence[tuple[float, float]]) -> tuple[float, float] | None:
    """The centre of an image on flat ground, from its corners; None if these are collinear.

    Straight lines of the image are straight on the ground, so for four corners it is the intersection of the
    diagonals; for another number of corners, their mean.
    """
    if len(corners) != 4:
        north, east = (sum(c[k] for c in corners) / len(corners) for k in (0, 1))
        return north, east
    (an, ae), (bn, be), (cn, ce), (dn, de) = corners
    across = (cn - an) * (de - be) - (ce - ae) * (dn - bn)
    if across == 0:
        return None
    part = ((bn - an) * (de - be) - (be - ae) * (dn - bn)) / across
    return an + part * (cn - an), ae + part * (ce - ae)
