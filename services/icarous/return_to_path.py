"""The way back: which waypoint to make for, and whether the way there is free of conflict.

Control is handed back only when the whole way back (the turn towards the resume point, the leg to
it and the waypoints after it) is free of predicted conflict over the look-ahead, and has been for
a persistence time. The persistence doubles with each takeover that follows soon after a handback,
so authority does not chatter.
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
"""A takeover this soon after a handback is a relapse."""
ALIKE = 1.02
"""A way that is longer than another by less than this factor may be taken for the shorter one."""
SAME_M = 1.0
"""What is told twice, over the bridge, is one place if it is no farther apart [m]."""


def flat(p: Position) -> Vec2:
    """North and east of a place [m]."""
    return Vec2(p.north_m, p.east_m)


def bearing_rad(p: Position, q: Position) -> float:
    """Direction from p to q, clockwise from north."""
    return math.atan2(q.east_m - p.east_m, q.north_m - p.north_m)


def goal_index(now: Motion, radius_m: float, waypoints: tuple[Position, ...], index: int) -> int:
    """The waypoint to make for: the first from `index` on that is not near nor passed abeam.

    Near is three turn radii: inside them a turn may not reach the point at all.
    """
    last, here = len(waypoints) - 1, flat(now.position)
    while index < last:
        if makes_for(here, flat(waypoints[index]), flat(waypoints[index + 1]), radius_m):
            break
        index += 1
    return min(index, last)


def way_on(told: Told, now: Motion, radius_m: float) -> tuple[Position, ...]:
    """The points that UxAS will fly by if it takes the vehicle back now: the waypoint ahead that it makes for, and
    those after it.

    It passes over no waypoint after the one that it has told as the place to resume, say where a task begins; if the
    place lies between two waypoints, as where a task's path was left, it comes back there.
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
"""A way that was planned a moment ago is joined so many turn radii farther on: nearer, a turn may not reach it."""


def onto(points: tuple[Position, ...], now: Motion, radius_m: float) -> tuple[Position, ...]:
    """The points that are flown if a route which another planner made a moment ago, from near here, is joined now: those from
    JOINS_AFTER turn radii along it on, or its end alone."""
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
    """The flyable ways that UxAS may take for the shortest one after a handback: that is it, and those that are
    hardly longer. To turn left or right is often all but the same, and both ends reckon with rounded numbers."""
    if beyond is None:
        return ((now.position, target),)
    heading = math.atan2(beyond.east_m - target.east_m, beyond.north_m - target.north_m)
    end = Pose(*target, heading)
    paths = dubins_paths(Pose(*now.position, now.heading_rad), end, radius_m)
    lengths_m = [sum(path.lengths_m) for path in paths]
    alike = paths[: bisect_right(lengths_m, ALIKE * lengths_m[0] + SAME_M)]
    # words whose turns have no length are one way, but for rounding
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
    """The flights from here onto points[0] and on through the others, of which UxAS takes one, at the speed of a pace
    as soon as the vehicle comes to it."""
    onto = rejoining(now, radius_m, points[0], points[1] if len(points) > 1 else None)
    return tuple(way_along(now, (*way[1:], *points[1:]), horizon_s, pace=pace) for way in onto)
