"""Shortest paths of bounded curvature between two poses (Dubins), and their division into legs.

Source: L. E. Dubins, "On curves of minimal length with a constraint on average curvature", 1957. The construction
here is by tangents to the turning circles. Headings are clockwise from north in the north/east plane, so a positive
turn is a right turn. A path is searched, never trusted: the legs that are flown are checked by the zone kernels.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np

from cratous.core.readings.tiered import swift
from cratous.core.routing.dubins_words import WORDS_MOST, legs, legs_length, words
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

RIGHT, STRAIGHT, LEFT = 1, 0, -1


class DubinsPath(NamedTuple):
    """Three segments from `start`: kinds (RIGHT, STRAIGHT, LEFT) and lengths [m]."""

    start: Pose
    radius_m: float
    kinds: tuple[int, int, int]
    lengths_m: tuple[float, float, float]

    @property
    def length_m(self) -> float:
        """Total length [m]."""
        return self.lengths_m[0] + self.lengths_m[1] + self.lengths_m[2]


def turn_radius_m(speed_m_s: float, bank_rad: float, gravity_m_s2: float = 9.80665) -> float:
    """Radius of a level coordinated turn [m]: v^2 / (g tan bank)."""
    return speed_m_s * speed_m_s / (gravity_m_s2 * math.tan(bank_rad))


def dubins_paths(start: Pose, end: Pose, radius_m: float) -> list[DubinsPath]:
    """All Dubins words that join the two poses, shortest first; never empty for radius_m > 0."""
    kinds, lengths = np.empty((WORDS_MOST, 3), np.int64), np.empty((WORDS_MOST, 3))
    north, east = end.north_m - start.north_m, end.east_m - start.east_m
    count = swift(words)(
        float(north), float(east), float(start.heading_rad), float(end.heading_rad),
        float(radius_m), kinds, lengths,
    )  # fmt: skip
    pairs = zip(kinds[:count].tolist(), lengths[:count].tolist(), strict=True)
    return [DubinsPath(start, radius_m, tuple(k), tuple(m)) for k, m in pairs]


def dubins(start: Pose, end: Pose, radius_m: float) -> DubinsPath:
    """The shortest Dubins path from start to end with turn radius radius_m [m] > 0."""
    return dubins_paths(start, end, radius_m)[0]


def pose_after(pose: Pose, kind: int, length_m: float, radius_m: float) -> Pose:
    """The pose after one segment: straight, or a right or left turn of the given length."""
    n, e, alt, h = pose
    if kind == STRAIGHT:
        return Pose(n + length_m * math.cos(h), e + length_m * math.sin(h), alt, h)
    after = h + kind * length_m / radius_m
    return Pose(
        n + kind * radius_m * (math.sin(after) - math.sin(h)),
        e - kind * radius_m * (math.cos(after) - math.cos(h)),
        alt,
        after,
    )


def cut(path: DubinsPath, end: Pose, chord_error_m: float = 0.5) -> tuple[Position, ...]:
    """The path as a polyline from start to end, both exactly; altitude is linear in length.

    An arc is divided into equal chords that deviate from it by at most chord_error_m [m].
    """
    found = swift(legs)(
        np.array(path.start, float), np.array(end, float), np.array(path.kinds, np.int64),
        np.array(path.lengths_m, float), float(path.radius_m), float(chord_error_m),
    )  # fmt: skip
    inner = [Position(*point) for point in found[1:-1].tolist()]
    return (Position(*path.start[:3]), *inner, Position(*end[:3]))


def cut_length_m(path: DubinsPath, chord_error_m: float = 0.5) -> float:
    """Length [m] of the polyline that `cut` returns, without building it."""
    kinds, lengths = np.array(path.kinds, np.int64), np.array(path.lengths_m, float)
    return float(swift(legs_length)(kinds, lengths, float(path.radius_m), float(chord_error_m)))


def polyline_length_m(points: tuple[Position, ...]) -> float:
    """Horizontal length of a polyline [m]."""
    return sum(
        math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        for p, q in itertools.pairwise(points)
    )
