"""Maximum distance from a frame's origin at which background shapes are shown."""

from __future__ import annotations

import math

from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2

NEAR_M = 2_000_000.0
"""Beyond this distance the projection is too distorted [m]."""


def is_near(place: Vec2, reach_m: float = 0.0) -> bool:
    """Whether a place [m], with everything within reach_m of it, is close enough; False for non-finite places."""
    origin = Vec2(0.0, 0.0)
    return all(map(math.isfinite, place)) and near_line(
        origin, place, place, max(NEAR_M - reach_m, 0.0)
    )
