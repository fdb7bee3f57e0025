"""Waypoints spaced as far apart as needed by an autopilot that flies by waypoints only.

An autopilot that turns short counts a waypoint as reached from two turn radii away, so with waypoints closer
than one radius it cuts every bend. Omitting waypoints moves the path by at most a stated distance, and each
resulting leg is checked against the zones by `leg_ok`.
"""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.geofence.distance import AT, FARTHER, edge_against
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.spec.mission import Position, Zone

TOLERANCE = 0.2
"""How far omitted waypoints may move a path, in turn radii."""


def spaced(
    points: Sequence[Position], least_m: float, off_m: float, zones: Sequence[Zone]
) -> tuple[Position, ...]:
    """A path with fewer points: its ends, and those of the others that are needed.

    A point closer than least_m to the previous kept point, or to the end, is omitted, unless a point would
    then be farther than off_m from its new leg or above or below it, or the leg would violate the zones
    (without padding).
    """
    return tuple(points[k] for k in needed(points, least_m, off_m, zones))


def needed(
    points: Sequence[Position], least_m: float, off_m: float, zones: Sequence[Zone]
) -> tuple[int, ...]:
    """The indices of the points that `spaced` keeps."""
    last, kept = len(points) - 1, [0]

    def leads(a: int, b: int) -> bool:
        p, q = points[a], points[b]
        return all(_along(points[k], p, q, off_m) for k in range(a + 1, b)) and (
            first_bad_leg((p, q), zones) is None
        )

    while kept[-1] != last:
        at = kept[-1]
        following = at + 1
        while following != last and near(points[at], points[following], least_m):
            if not leads(at, following + 1):
                break
            following += 1
        kept.append(following)
    while len(kept) > 2 and near(points[kept[-2]], points[last], least_m):
        if not leads(kept[-3], last):
            break
        del kept[-2]
    return tuple(kept)


def near(p: Position, q: Position, least_m: float) -> bool:
    """Whether two points are closer than least_m [m] horizontally."""
    return edge_against(_flat(p), _flat(q), _flat(q), least_m) not in (AT, FARTHER)


def _along(point: Position, p: Position, q: Position, off_m: float) -> bool:
    """Whether a point is within off_m of a leg horizontally, and within the altitude range of its ends."""
    beside = edge_against(_flat(point), _flat(p), _flat(q), off_m)
    level = edge_against(_height(point), _height(p), _height(q), 0.0)
    return FARTHER not in (beside, level)


def _flat(p: Position) -> Vec2:
    return Vec2(p.north_m, p.east_m)


def _height(p: Position) -> Vec2:
    return Vec2(p.alt_m, 0.0)
