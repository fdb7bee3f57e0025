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
_ways: dict[tuple[int, float], tuple[Sequence[Leg], Bounds | None]] = {}


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
    known = _ways.get((id(way), until_s))
    if known is not None and known[0] is way:
        return known[1]
    said = bounds(way, until_s)
    if len(_ways) >= MOST_WAYS:
        _ways.clear()
    _ways[id(way), until_s] = way, said
    return said


def bounds(legs: Sequence[Leg], until_s: float) -> Bounds | None:
    """The bounds of consecutive legs up to an instant [s]; None if none begins before it."""
    low_n = low_e = math.inf
    high_n = high_e = speed = -math.inf
    # compared, not by min and max: a long path is looked through at each heartbeat
    for start_s, duration_s, (north, east, _), (north_s, east_s, _) in legs:
        if start_s >= until_s:
            break
        left_s = until_s - start_s
        lasts_s = duration_s if duration_s < left_s else left_s
        there_n, there_e, leg_m_s = (
            north + north_s * lasts_s,
            east + east_s * lasts_s,
            math.hypot(north_s, east_s),
        )
        south_m, north_m = (north, there_n) if north < there_n else (there_n, north)
        west_m, east_m = (east, there_e) if east < there_e else (there_e, east)
        if south_m < low_n:
            low_n = south_m
        if north_m > high_n:
            high_n = north_m
        if west_m < low_e:
            low_e = west_m
        if east_m > high_e:
            high_e = east_m
        if leg_m_s > speed:
            speed = leg_m_s
    return None if low_n == math.inf else ((low_n, high_n, low_e, high_e), speed)
