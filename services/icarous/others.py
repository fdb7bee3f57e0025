"""How other vehicles of ours are taken to fly: along the way that UxAS flies them by, while they keep to it.

UxAS tells each instance the ways of the other vehicles, and that one is over as ICAROUS takes the other vehicle. One
that is farther off the way that was told than what the permits allow for is taken to fly straight on, like an intruder
of which nothing was told; so is everybody while UxAS is not heard, and one that flies in another direction than its way.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import NamedTuple

from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.manoeuvre import Motion, fly_to, smallest_turn
from cratous.core.avoidance.prediction import Intruder, Piece
from cratous.core.avoidance.way_ahead import turns
from cratous.core.routing.polylines import Track
from cratous.services.icarous.deviation import keeps_to
from cratous.services.icarous.ending import TRACKING_S, TURN_MARGIN
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.traffic_monitor import TURNING_RAD_S, Tracks
from cratous.spec.mission import Daa, Position, Velocity

WINDOW_BEATS = 4
"""Where a vehicle is on its way is looked for as far ahead of where it was as it flies in so many heartbeats."""
LINK_LOST_MS = 2000
"""What was told counts for so long after UxAS was last heard [ms]: four heartbeats."""
ASTRAY_S = 2.0
"""One whose course is farther off its way than it turns in this time does not fly along it [s]."""
ALWAYS_S = 3600.0
"""One that ICAROUS steers is taken to fly on straight for this long [s]."""


class Followed(NamedTuple):
    """A way as it was told, and where on it the vehicle was at the last heartbeat [m of arc length]."""

    vehicle_id: int
    points: tuple[Position, ...]
    track: Track
    at_m: float


Ways = tuple[Followed, ...]


def with_ways(
    before: Ways,
    told: Told,
    sensed: Sensed,
    daa: Daa,
    beat_s: float,
    courses: Tracks = (),
    until_s: float = math.inf,
) -> tuple[Ways, tuple[Intruder, ...]]:
    """The ways that were told, and everybody as is to be reckoned with: by the way that was told while it is kept to.
    before, courses: what this and everybody's course were at the last heartbeat; beat_s: from one to the next [s];
    until_s: no leg of a way that was told is needed that begins later than this [s from now]."""
    if not in_time(told.heard_ms, sensed.now_ms, LINK_LOST_MS):
        return (), sensed.intruders
    steered, was = dict(told.steered), dict(courses)
    known, points_of = {one.vehicle_id: one for one in before}, dict(told.others)
    ways, others = list[Followed](), list[Intruder]()
    for other in sensed.intruders:
        if other.id in steered:
            others.append(_steered(other, steered[other.id], was.get(other.id), sensed, beat_s))
            continue
        points, speed = points_of.get(other.id, ()), _speed_m_s(other)
        if not points or not speed:
            others.append(other)
            continue
        old = known.get(other.id)
        window_m = WINDOW_BEATS * beat_s * speed
        if old is None or old.points is not points:
            # on a new connection it may be anywhere on it
            old = Followed(other.id, points, Track(points), 0.0)
            window_m = old.track.length_m
        at_m = old.track.nearest(other.position, old.at_m, window_m).s_m
        ways.append(Followed(other.id, points, old.track, at_m))
        kept = keeps_to(old.track.at(at_m), other.position, daa, seen=other.spread)
        off_rad = smallest_turn(old.track.heading_rad(at_m), _course_rad(other.velocity))
        kept = kept and not turns(off_rad, _turn_rate(other, sensed), ASTRAY_S)
        way = _along(old.track, at_m, other, until_s) if kept else ()
        hold_m = _hold_m(other, sensed) if way else 0.0
        id_, position, velocity, cooperates, _, _, spread = other
        others.append(Intruder(id_, position, velocity, cooperates, way, hold_m, spread))
    return tuple(ways), tuple(others)


def to_their_ends(ways: Ways, others: tuple[Intruder, ...]) -> tuple[Intruder, ...]:
    """The same with each way to its end that `with_ways` has given for a while only; ways: as it gave them."""
    known = {one.vehicle_id: one for one in ways}
    return tuple(
        other._replace(way=_along(known[other.id].track, known[other.id].at_m, other))
        if other.way and other.id in known
        else other
        for other in others
    )


def _speed_m_s(other: Intruder) -> float:
    return math.hypot(other.velocity.north_m_s, other.velocity.east_m_s)


def _hold_m(other: Intruder, sensed: Sensed) -> float:
    """How far from the end of its way a vehicle is that circles there, if it banks like this one [m]."""
    speed = _speed_m_s(other)
    tightest_m = speed / _turn_rate(other, sensed)
    return 2 * TURN_MARGIN * tightest_m + TRACKING_S * speed


def _turn_rate(other: Intruder, sensed: Sensed) -> float:
    """How fast a vehicle that flies turns, if it banks like this one [rad/s]."""
    return sensed.ability.turn_rate_rad_s * sensed.motion.speed_m_s / _speed_m_s(other)


def _steered(
    other: Intruder, to: Velocity, was_rad: float | None, sensed: Sensed, beat_s: float
) -> Intruder:
    """One that turns to a velocity and then flies straight on, if it banks like this one and turns there; was_rad:
    its course a heartbeat ago."""
    speed, v = _speed_m_s(other), other.velocity
    course, goal = _course_rad(v), _course_rad(to)
    if not speed:
        return other
    if was_rad is not None:
        left = abs(smallest_turn(course, goal))
        nearer = max(0.0, abs(smallest_turn(was_rad, goal)) - left)
        # neither there nor turning there: what was told is not what it flies
        if turns(left, TURNING_RAD_S, beat_s) and not turns(nearer, TURNING_RAD_S, beat_s):
            return other
    own = sensed.ability
    ability = own._replace(turn_rate_rad_s=_turn_rate(other, sensed))
    now = Motion(other.position, course, speed, -v.down_m_s)
    # no faster, slower or steeper than it or this one flies, whatever is told
    low, high = min(own.min_speed_m_s, speed), max(own.max_speed_m_s, speed)
    most = max(own.max_climb_m_s, abs(v.down_m_s))
    speed, climb = min(max(math.hypot(*to[:2]), low), high), min(max(-to.down_m_s, -most), most)
    way = fly_to(now, ability, goal, speed, climb, ALWAYS_S, ALWAYS_S)
    return other._replace(way=way)


def _course_rad(v: Velocity) -> float:
    return math.atan2(v.east_m_s, v.north_m_s)


def _along(
    track: Track, at_m: float, other: Intruder, until_s: float = math.inf
) -> tuple[Piece, ...]:
    """Flight along a track from at_m on at the present speed, as far beside it as the vehicle is now. until_s: legs that
    begin later than this [s] are left out."""
    speed, pieces = _speed_m_s(other), list[Piece]()
    if not speed:
        return ()
    (north_m, east_m, alt_m), t_s, first = other.position, 0.0, bisect_right(track.s_m, at_m)
    last = bisect_right(track.s_m, at_m + until_s * speed) + 1
    ahead = track.points[first - 1 : last], track.points[first:last], track.s_m[first:last]
    for a, b, end_m, (north, east) in zip(*ahead, track.directions[first - 1 :], strict=False):
        left_s = (end_m - at_m) / speed
        leg_s = math.hypot(b.north_m - a.north_m, b.east_m - a.east_m) / speed
        down = (a.alt_m - b.alt_m) / leg_s
        v = Velocity(north * speed, east * speed, down)
        pieces.append(Piece(t_s, left_s, Position(north_m, east_m, alt_m), v))
        north_m, east_m = north_m + v.north_m_s * left_s, east_m + v.east_m_s * left_s
        alt_m, t_s, at_m = alt_m - down * left_s, t_s + left_s, end_m
    return tuple(pieces)
