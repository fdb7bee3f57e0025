"""Positions on a polyline by horizontal arc length, and its remainder.

Nothing here decides whether anything is safe: it locates an aircraft on its path, and what is flown is checked leg by
leg by the zone and well-clear kernels.
"""

from __future__ import annotations

import itertools
import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import NamedTuple

from cratous.spec.mission import Position


class Near(NamedTuple):
    """A position relative to a track: arc length s [m] and horizontal distance from it, positive right [m]."""

    s_m: float
    offset_m: float


@dataclass(frozen=True, init=False)
class Track:
    """A polyline without repeated points, extended straight beyond both ends.

    s_m: arc length at each point [m]; directions: of each leg, north and east of a unit vector.
    """

    points: tuple[Position, ...]
    s_m: tuple[float, ...]
    directions: tuple[tuple[float, float], ...]

    def __init__(self, points: tuple[Position, ...], heading_rad: float = 0.0) -> None:
        """points: one or more; heading_rad: direction if they all coincide."""
        kept = [points[0]]
        for point in points[1:]:
            last = kept[-1]
            if math.hypot(point.north_m - last.north_m, point.east_m - last.east_m) > 1e-6:
                kept.append(point)
            else:
                kept[-1] = point
        s_m, directions = [0.0], list[tuple[float, float]]()
        for a, b in itertools.pairwise(kept):
            north, east = b.north_m - a.north_m, b.east_m - a.east_m
            length = math.hypot(north, east)
            directions.append((north / length, east / length))
            s_m.append(s_m[-1] + length)
        if not directions:
            directions.append((math.cos(heading_rad), math.sin(heading_rad)))
        object.__setattr__(self, "points", tuple(kept))
        object.__setattr__(self, "s_m", tuple(s_m))
        object.__setattr__(self, "directions", tuple(directions))

    @property
    def length_m(self) -> float:
        """Length of the whole polyline [m]."""
        return self.s_m[-1]

    def _leg(self, s_m: float) -> int:
        return min(max(bisect_right(self.s_m, s_m) - 1, 0), len(self.directions) - 1)

    def at(self, s_m: float) -> Position:
        """The point at arc length s; on the straight extension beyond the ends, at the altitude of the end."""
        leg = self._leg(s_m)
        a = self.points[leg]
        along = s_m - self.s_m[leg]
        north, east = self.directions[leg]
        alt = a.alt_m
        if leg + 1 < len(self.points):
            share = along / (self.s_m[leg + 1] - self.s_m[leg])
            alt += min(max(share, 0.0), 1.0) * (self.points[leg + 1].alt_m - a.alt_m)
        return Position(a.north_m + north * along, a.east_m + east * along, alt)

    def heading_rad(self, s_m: float) -> float:
        """Direction of the track at arc length s, clockwise from north."""
        north, east = self.directions[self._leg(s_m)]
        return math.atan2(east, north)

    def nearest(self, p: Position, from_m: float, window_m: float) -> Near:
        """The nearest position to p within [from_m, from_m + window_m]; on the straight extension past the end.

        The window keeps the search from jumping to a later leg that crosses this one.
        """
        best, best_d = Near(from_m, math.inf), math.inf
        leg, last = self._leg(from_m), len(self.directions) - 1
        while leg <= last:
            a, (north, east) = self.points[leg], self.directions[leg]
            start = self.s_m[leg]
            if start > from_m + window_m:
                break
            dn, de = p.north_m - a.north_m, p.east_m - a.east_m
            along = max(dn * north + de * east, from_m - start)
            if leg < last:
                along = min(along, self.s_m[leg + 1] - start)
            along = min(along, from_m + window_m - start)
            off_n, off_e = dn - north * along, de - east * along
            d = math.hypot(off_n, off_e)
            if d < best_d:
                side = north * off_e - east * off_n
                best, best_d = Near(start + along, math.copysign(d, side)), d
            leg += 1
        return best

    def rest(self, s_m: float) -> tuple[Position, ...]:
        """The points from arc length s to the end."""
        if s_m >= self.length_m:
            return (self.points[-1],)
        leg = self._leg(s_m)
        return (self.at(s_m), *self.points[leg + 1 :])


def circle_points(
    centre: tuple[float, float], radius_m: float, clockwise: bool, start: Position, legs: int = 72
) -> tuple[Position, ...]:
    """One lap as a closed polyline from `start` (taken to lie on the circle) back to it."""
    angle = math.atan2(start.east_m - centre[1], start.north_m - centre[0])
    step = (2 if clockwise else -2) * math.pi / legs
    inner = (
        Position(
            centre[0] + radius_m * math.cos(angle + k * step),
            centre[1] + radius_m * math.sin(angle + k * step),
            start.alt_m,
        )
        for k in range(1, legs)
    )
    return (start, *inner, start)
