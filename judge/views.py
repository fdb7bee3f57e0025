"""Whether an image shows the ground as a task requires: not close to the horizon, and near the
required view angle.

The four corners of an image have equal angular distance from its centre: the view direction is that
of the sum of the unit vectors to the corners. So it follows from the aircraft's position and its
reported footprint.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cratous.judge.fields import Node

Point = tuple[float, float]
FLATTEST_DEG = 5.0
"""Minimum depression angle of anything that counts as seen [deg]."""
OFF_VIEW_DEG = 30.0
"""Maximum deviation in elevation of the image centre from a required view [deg]."""
LEEWAY_DEG = 0.05
"""Accuracy of angles [deg]: positions in degrees are accurate to about a millimetre, and the Earth is round."""


def in_log(data: Node) -> tuple[float, ...]:
    """Depression angle of each permitted view of a task in a log's mission [deg]; empty: any."""
    if not data.has("view"):
        return ()
    views = [data["view"], *(data.get("views", []) if data.has("views") else ())]
    return tuple(abs(math.degrees(view["elevation_rad"].real)) for view in views)


def in_file(data: Node) -> tuple[float, ...]:
    """The same for a task in a mission file."""
    views = data["views"] if data.has("views") else [data["view"]] if data.has("view") else []
    return tuple(abs(view["elevation_deg"].real) for view in views)


def as_asked(
    here: tuple[float, float, float], ground_m: float, corners: Sequence[Point],
    views_deg: Sequence[float],
) -> bool:  # fmt: skip
    """Whether an image with these ground corners counts, seen from a position (north, east, altitude) [m]."""
    down_m = here[2] - ground_m
    if down_m <= 0:
        return False
    north = east = down = 0.0
    for n, e in corners:
        away = n - here[0], e - here[1], down_m
        far = math.hypot(*away)
        if math.degrees(math.asin(down_m / far)) < FLATTEST_DEG - LEEWAY_DEG:
            return False
        north, east, down = (a + b / far for a, b in zip((north, east, down), away, strict=True))
    middle_deg = math.degrees(math.atan2(down, math.hypot(north, east)))
    off = OFF_VIEW_DEG + LEEWAY_DEG
    return not views_deg or any(abs(middle_deg - one) <= off for one in views_deg)
