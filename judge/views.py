"""Whether an image shows the ground as a task asks: neither near the horizon nor far from the view asked for.

The four corners of an image are equally far from its middle, as angles: the middle of its view is the direction in
which the unit vectors to the corners add up. So it follows from where an aircraft was and what it says to have seen.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cratous.judge.fields import Node

Point = tuple[float, float]
FLATTEST_DEG = 5.0
"""What is looked at more flatly is not seen."""
OFF_VIEW_DEG = 30.0
"""The middle of an image may be this much higher or lower than a view that is asked for."""
LEEWAY_DEG = 0.05
"""Angles are not told apart better: places come as degrees, to about a millimetre, and the Earth is round."""


def in_log(data: Node) -> tuple[float, ...]:
    """How far down each view that will do looks, of a task in a log's mission [deg]; none: any will do."""
    if not data.has("view"):
        return ()
    views = [data["view"], *(data.get("views", []) if data.has("views") else ())]
    return tuple(abs(math.degrees(view["elevation_rad"].real)) for view in views)


def in_file(data: Node) -> tuple[float, ...]:
    """The same of a task in a mission file."""
    views = data["views"] if data.has("views") else [data["view"]] if data.has("view") else []
    return tuple(abs(view["elevation_deg"].real) for view in views)


def as_asked(
    here: tuple[float, float, float], ground_m: float, corners: Sequence[Point],
    views_deg: Sequence[float],
) -> bool:  # fmt: skip
    """Whether an image with these corners on the ground counts, seen from a place (north, east, altitude) [m]."""
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
