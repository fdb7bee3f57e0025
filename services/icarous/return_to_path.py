"""The way back: which waypoint to make for, and whether the way there is free of conflict.

Control is handed back only when the whole way back (the turn towards the resume point, the leg to
it and the waypoints after it) is free of predicted conflict over the look-ahead, and has been for
a persistence time. The persistence doubles with each takeover that follows soon after a handback,
so authority does not chatter.
"""

from __future__ import annotations

import math

from cratous.core.avoidance.manoeuvre import Motion, Way, way_along
from cratous.core.avoidance.way_ahead import makes_for
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import cut, dubins
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

PERSIST_MS = 1500
"""The way back must have been free for this long [ms]: three heartbeats."""
RELAPSE_MS = 20_000
"""A takeover this soon after a handback is a relapse."""


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


def rejoin(
    now: Motion, radius_m: float, target: Position, beyond: Position | None
) -> tuple[Position, ...]:
    """The shortest flyable way from here to `target`, arriving in the direction of `beyond`.

    The executive flies the same way after the handback, so what was checked is what is flown.
    """
    if beyond is None:
        return (now.position, target)
    heading = math.atan2(beyond.east_m - target.east_m, beyond.north_m - target.north_m)
    end = Pose(*target, heading)
    return cut(dubins(Pose(*now.position, now.heading_rad), end, radius_m), end)


def way_back(now: Motion, radius_m: float, points: tuple[Position, ...], horizon_s: float) -> Way:
    """The flight from here onto points[0] and on through the others."""
    onto = rejoin(now, radius_m, points[0], points[1] if len(points) > 1 else None)
    return way_along(now, (*onto[1:], *points[1:]), horizon_s)
