"""Which looks of a camera count for a search: none near the horizon, and none far from the view that is asked for.

A look is counted by where its image lies on the ground, as seen from the place below the aircraft: the middle of the
image in a ring, each corner within a reach. A ring is an interval of elevations, since tan(elevation) is height
over distance. Neither depends on what the camera says of itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from cratous.spec.mission import Camera, Task, View

if TYPE_CHECKING:
    import numpy as np

FLATTEST_RAD = math.radians(5)
"""What is looked at more flatly than this is near the horizon, and not seen."""
OFF_VIEW_RAD = math.radians(30)
"""The middle of an image is at most this much higher or lower than the view that is asked for."""
COARSER = 1.01
"""A ground sample distance is kept up to this many times the one that is asked for."""


class Ring(NamedTuple):
    """Bounds of a distance on the ground [m]."""

    least_m: float
    most_m: float


def reach_m(height_m: float) -> float:
    """How far from the place below it an aircraft at a height sees anything [m]."""
    return height_m / math.tan(FLATTEST_RAD)


def rings(task: Task, height_m: float) -> tuple[Ring, ...]:
    """Where the middle of an image has to lie, in one of these; height_m: above the ground, > 0."""
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
    """Which of planned looks (n, 5), as `sensor.Look`, are near enough to a view that the task asks for, (n,) bool."""
    import numpy as np

    if task.view is None:
        return np.ones(len(looks), bool)
    away = np.hypot(looks[:, 3] - looks[:, 0], looks[:, 4] - looks[:, 1])
    down = np.clip(np.arctan2(height_m, away), -camera.max_elevation_rad, -camera.min_elevation_rad)
    wanted = [abs(view.elevation_rad) for view in (task.view, *task.views) if view is not None]
    return np.any([np.abs(down - one) <= OFF_VIEW_RAD for one in wanted], axis=0)


def sharp_within_m(task: Task, camera: Camera, hfov_rad: float, height_m: float) -> float:
    """How far away on the ground the middle of an image is as sharp as the task asks [m]; negative: nowhere.

    Infinite where no ground sample distance is asked for, or the camera's pixels are not known.
    """
    if not max(task.gsd_m, 0.0) or camera.pixels == 0:
        return math.inf
    slant_m = COARSER * task.gsd_m * camera.pixels / (2 * math.tan(hfov_rad / 2))
    squared = slant_m**2 - height_m**2
    return math.copysign(math.sqrt(abs(squared)), squared)


def middle(corners: Sequence[tuple[float, float]]) -> tuple[float, float] | None:
    """Where the middle of an image lies on flat ground, by its corners; None where these are in one line.

    Straight lines of the image are straight on the ground, so of four corners it is where the diagonals cross. With
    another number of them it is their mean.
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
