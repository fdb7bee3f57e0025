"""The way back: the waypoint to make for, and the flyable ways there.

Control is handed back only when the whole way back (the turn towards the resume point, the leg to it and the
waypoints after it) has been free of predicted conflict over the look-ahead for a persistence time. This time
doubles with each takeover soon after a handback, which provides hysteresis against chattering authority.
"""

from __future__ import annotations

import math
from bisect import bisect_right

from cratous.core.avoidance.manoeuvre import Motion, Pace, Way, way_along
from cratous.core.avoidance.way_ahead import makes_for, near_line
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import cut, dubins_paths
from cratous.core.routing.polylines import Track
from cratous.services.icarous.inbox import Told
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

PERSIST_MS = 1500
"""The way back must have been free for this long [ms]: three heartbeats."""
RELAPSE_MS = 20_000
"""A takeover this soon after a handback is a relapse [ms]."""
ALIKE = 1.02
"""A way longer than the shortest one by less than this factor may be taken for it."""
SAME_M = 1.0
"""Places received over the bridge are the same if they are no farther apart than this [m]."""


def flat(p: Position) -> Vec2:
    """North and east coordinates of a place [m]."""
    return Vec2(p.north_m, p.east_m)


def bearing_rad(p: Position, q: Position) -> float:
    """Direction from p to q, clockwise from north [rad]."""
    return math.atan2(q.east_m - p.east_m, q.north_m - p.north_m)


def goal_index(now: Motion, radius_m: float, waypoints: tuple[Position, ...], index: int) -> int:
    """Index of the waypoint to make for: the first from `index` on that is neither near nor passed abeam.

    Near means within three turn radii, where a turn may not reach the point.
    """
    last, here = len(waypoints) - 1, flat(now.position)
    while index < last:
        if makes_for(here, flat(waypoints[index]), flat(waypoints[index + 1]), radius_m):
            break
        index += 1
    return min(index, last)


def way_on(told: Told, now: Motion, radius_m: float) -> tuple[Position, ...]:
    """The points along which UxAS will fly if it takes the vehicle back now: the waypoint ahead and those
    after it.

    It does not skip the waypoint announced as the resume point, e.g. the start of a task. If that point lies
    between two waypoints, as where a task's path was left, it returns there.
    """
    waypoints, index = told.waypoints, min(told.next_index, len(told.waypoints) - 1)
    last = len(waypoints) - 1
    if told.resume is not None:
        same = [k for k, place in enumerate(waypoints) if k >= index and _same(place, told.resume)]
        if not same:
            return (told.resume, *waypoints[min(told.next_index, len(waypoints)) :])
        last = same[0]
    track = Track(waypoints[max(index - 1, 0) : last + 1], now.heading_rad)
    near = track.nearest(now.position, 0.0, track.length_m)
    ahead = min(bisect_right(track.s_m, near.s_m), len(track.s_m) - 1)
    goal = goal_index(now, radius_m, track.points, ahead)
    return (*track.points[goal:], *waypoints[last + 1 :])


JOINS_AFTER = 3.0
"""A route from another planner is joined this many turn radii ahead: closer, a turn may not reach it."""


def onto(points: tuple[Position, ...], now: Motion, radius_m: float) -> tuple[Position, ...]:
    """The points flown if another planner's recent route from near here is joined now: those from JOINS_AFTER
    turn radii ahead, or its end alone.
    """
    track = Track(points, now.heading_rad)
    near = track.nearest(now.position, 0.0, track.length_m)
    return tuple(track.rest(min(track.length_m, near.s_m + JOINS_AFTER * radius_m)))


def _same(p: Position, q: Position) -> bool:
    return near_line(flat(p), flat(q), flat(q), SAME_M)


def rejoin(
    now: Motion, radius_m: float, target: Position, beyond: Position | None
) -> tuple[Position, ...]:
    """The shortest flyable way from here to `target`, arriving in the direction of `beyond`."""
    return rejoining(now, radius_m, target, beyond)[0]


def rejoining(
    now: Motion, radius_m: float, target: Position, beyond: Position | None
) -> tuple[tuple[Position, ...], ...]:
    """The flyable ways that UxAS may fly after a handback: the shortest, and those that are nearly as short.

    A left and a right turn are often nearly equal, and both sides compute with rounded numbers.
    """
    if beyond is None:
        return ((now.position, target),)
    heading = math.atan2(beyond.east_m - target.east_m, beyond.north_m - target.north_m)
    end = Pose(*target, heading)
    paths = dubins_paths(Pose(*now.position, now.heading_rad), end, radius_m)
    lengths_m = [sum(path.lengths_m) for path in paths]
    alike = paths[: bisect_right(lengths_m, ALIKE * lengths_m[0] + SAME_M)]
    # paths with turns of zero length are the same way, up to rounding
    ways = dict[tuple[tuple[float, float], ...], tuple[Position, ...]]()
    for way in (cut(path, end) for path in alike):
        ways.setdefault(tuple((round(p.north_m, 2), round(p.east_m, 2)) for p in way), way)
    return tuple(ways.values())


def ways_back(
    now: Motion,
    radius_m: float,
    points: tuple[Position, ...],
    horizon_s: float,
    pace: Pace | None = None,
) -> tuple[Way, ...]:
    """The predicted flights from here onto points[0] and along the rest, of which UxAS flies one. pace: speed
    to accelerate to.
    """
    onto = rejoining(now, radius_m, points[0], points[1] if len(points) > 1 else None)
    return tuple(way_along(now, (*way[1:], *points[1:]), horizon_s, pace=pace) for way in onto)
