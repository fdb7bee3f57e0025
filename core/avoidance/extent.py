"""Bounds on where straight flights lead and how fast, by which `core.avoidance.prediction` skips work.

One trajectory is checked against many intruders, and one intruder's path against many trajectories, so the latest
result of either is cached by identity.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from cratous.spec.mission import Position, Velocity

Leg = tuple[float, float, Position, Velocity]
"""As `core.avoidance.prediction.Piece`."""
Extent = tuple[float, float, float, float]
"""The least and the greatest north, and east [m]."""
Bounds = tuple[Extent, float]
"""Where legs lead, and the greatest horizontal speed on them [m/s]."""

MOST_WAYS = 4096
_latest: list[tuple[Sequence[Leg], tuple[float, Bounds | None]]] = [((), (0.0, None))]
_ways: dict[int, tuple[Sequence[Leg], float, Bounds | None]] = {}


def fastest(legs: Sequence[Leg]) -> float:
    """The greatest horizontal speed of legs [m/s]."""
    return max(math.hypot(velocity[0], velocity[1]) for _, _, _, velocity in legs)


def reached(pieces: Sequence[Leg]) -> tuple[float, Bounds | None]:
    """The end time of segments [s], and their bounds; None if one does not end."""
    known, said = _latest[0]
    if known is pieces and pieces:
        return said
    until_s = max(start_s + duration_s for start_s, duration_s, _, _ in pieces)
    said = until_s, bounds(pieces, math.inf) if until_s < math.inf else None
    if isinstance(pieces, tuple):  # of a list the pieces may change
        _latest[0] = pieces, said
    return said


def reached_until(way: Sequence[Leg], until_s: float) -> Bounds | None:
    """The bounds of a path up to an instant [s]; None if it begins no sooner. An intruder that stays where its path
    ends adds no position to these.
    """
    known = _ways.get(id(way))
    if known is not None and known[0] is way and known[1] == until_s:
        return known[2]
    said = bounds(way, until_s)
    if len(_ways) >= MOST_WAYS:
        _ways.clear()
    _ways[id(way)] = way, until_s, said
    return said


def bounds(legs: Sequence[Leg], until_s: float) -> Bounds | None:
    """The bounds of consecutive legs up to an instant [s]; None if none begins before it."""
    low_n = low_e = math.inf
    high_n = high_e = speed = -math.inf
    for start_s, duration_s, (north, east, _), (north_s, east_s, _) in legs:
        if start_s >= until_s:
            break
        lasts_s = min(duration_s, until_s - start_s)
        there_n, there_e = north + north_s * lasts_s, east + east_s * lasts_s
        low_n, high_n = min(low_n, north, there_n), max(high_n, north, there_n)
        low_e, high_e = min(low_e, east, there_e), max(high_e, east, there_e)
        speed = max(speed, math.hypot(north_s, east_s))
    return None if low_n == math.inf else ((low_n, high_n, low_e, high_e), speed)
