"""Shortest paths of bounded curvature between two poses (Dubins), and their cutting into legs.

Source: L. E. Dubins, "On curves of minimal length with a constraint on average curvature", 1957.
The construction here is by tangents to the turning circles. Headings are clockwise from north in
the north/east plane, so a positive turn is a right turn. A path is searched, never trusted: the
legs that are flown are checked by the zone kernels.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

from cratous.core.kernel import driver
from cratous.spec.mission import Position
from cratous.spec.plan import Pose

RIGHT, STRAIGHT, LEFT = 1, 0, -1
_FULL = 2 * math.pi
_CLOSED = 1e-9  # a turn this close to a full one is rounding noise [rad]


class DubinsPath(NamedTuple):
    """Three pieces from `start`: kinds (RIGHT, STRAIGHT, LEFT) and lengths [m]."""

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


def _angle(angle: float) -> float:
    """The angle in [0, 2 pi), with rounding noise just below a full turn taken as none."""
    angle %= _FULL
    return 0.0 if _FULL - angle < _CLOSED else angle


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok"))
def dubins_paths(start: Pose, end: Pose, radius_m: float) -> list[DubinsPath]:
    """All Dubins words that join the two poses, shortest first; never empty for radius_m > 0.

    With the turning circles of the first and last piece given, the middle piece is a common
    tangent (outer for equal, inner for opposite senses) or a third circle touching both.
    """
    r, a, b = radius_m, start.heading_rad, end.heading_rad
    north, east = end.north_m - start.north_m, end.east_m - start.east_m
    sin_a, cos_a, sin_b, cos_b = math.sin(a), math.cos(a), math.sin(b), math.cos(b)
    found: list[tuple[float, tuple[int, int, int], tuple[float, float, float]]] = []
    for one in (RIGHT, LEFT):
        for two in (RIGHT, LEFT):
            # from the first circle's centre to the last one's
            x = north - two * r * sin_b + one * r * sin_a
            y = east + two * r * cos_b - one * r * cos_a
            gap, bearing = math.hypot(x, y), math.atan2(y, x)
            if one == two:
                if gap < 1e-9 * r:
                    bearing = a
                first, last = _angle(one * (bearing - a)), _angle(one * (b - bearing))
                pieces = (first * r, gap, last * r)
                found.append((sum(pieces), (one, STRAIGHT, two), pieces))
                if gap < 4 * r:
                    bend = math.acos(gap / (4 * r))
                    for side in (1, -1):
                        # the middle circle lies to one or the other side of the centre line
                        to_middle = bearing + side * bend
                        to_last = bearing - side * bend
                        h1 = to_middle + one * math.pi / 2
                        h2 = to_last + one * math.pi / 2 + math.pi
                        pieces = (
                            _angle(one * (h1 - a)) * r,
                            _angle(one * (h1 - h2)) * r,
                            _angle(one * (b - h2)) * r,
                        )
                        found.append((sum(pieces), (one, -one, one), pieces))
            elif gap >= 2 * r:
                heading = bearing + one * math.asin(2 * r / gap)
                run = math.sqrt(gap * gap - 4 * r * r)
                pieces = (_angle(one * (heading - a)) * r, run, _angle(two * (b - heading)) * r)
                found.append((sum(pieces), (one, STRAIGHT, two), pieces))
    found.sort()
    return [DubinsPath(start, r, kinds, pieces) for _, kinds, pieces in found]


def dubins(start: Pose, end: Pose, radius_m: float) -> DubinsPath:
    """The shortest Dubins path from start to end with turn radius radius_m [m] > 0."""
    return dubins_paths(start, end, radius_m)[0]


def pose_after(pose: Pose, kind: int, length_m: float, radius_m: float) -> Pose:
    """The pose after one piece: straight on, or a right or left turn of the given length."""
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

    An arc is cut into equal chords that leave it by at most chord_error_m [m].
    """
    step = 2 * math.acos(max(0.0, 1 - chord_error_m / path.radius_m)) * path.radius_m
    total = path.length_m or 1.0
    climb = end.alt_m - path.start.alt_m
    points = [Position(*path.start[:3])]
    pose, flown = path.start, 0.0
    for kind, length in zip(path.kinds, path.lengths_m, strict=True):
        if length <= 1e-6:
            continue
        count = 1 if kind == STRAIGHT else max(1, math.ceil(length / step))
        for k in range(1, count + 1):
            at = pose_after(pose, kind, length * k / count, path.radius_m)
            alt = path.start.alt_m + climb * (flown + length * k / count) / total
            points.append(Position(at.north_m, at.east_m, alt))
        pose, flown = pose_after(pose, kind, length, path.radius_m), flown + length
    if len(points) == 1:
        points.append(points[0])
    points[-1] = Position(*end[:3])
    return tuple(points)


def cut_length_m(path: DubinsPath, chord_error_m: float = 0.5) -> float:
    """Length [m] of the polyline that `cut` makes, without making it."""
    r = path.radius_m
    step = 2 * math.acos(max(0.0, 1 - chord_error_m / r)) * r
    total = 0.0
    for kind, length in zip(path.kinds, path.lengths_m, strict=True):
        if kind == STRAIGHT or length <= 1e-6:
            total += length
        else:
            count = max(1, math.ceil(length / step))
            total += count * 2 * r * math.sin(length / (2 * r * count))
    return total


def polyline_length_m(points: tuple[Position, ...]) -> float:
    """Horizontal length of a polyline [m]."""
    return sum(
        math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        for p, q in itertools.pairwise(points)
    )
