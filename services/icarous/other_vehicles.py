"""Predicted flight of other own vehicles: along their routes under UxAS, while they keep to them.

UxAS sends each instance the routes of the other vehicles, and revokes a route when ICAROUS takes that vehicle
over. A vehicle farther off its route than the permits allow for is predicted to fly straight on, like an
unknown intruder; so is one that flies in another direction than its route, and every vehicle while UxAS is
not heard.
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
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TRACKING_S, TURN_MARGIN
from cratous.services.icarous.traffic_monitor import TURNING_RAD_S, Tracks
from cratous.spec.mission import Daa, Position, Velocity

WINDOW_BEATS = 4
"""The progress of a vehicle is searched for within the distance that it flies in this many heartbeats."""
LINK_LOST_MS = 2000
"""Routes remain valid for this long after UxAS was last heard [ms]: four heartbeats."""
ASTRAY_S = 2.0
"""A vehicle is off its route if aligning with it would take a turn longer than this [s]."""
ALWAYS_S = 3600.0
"""A vehicle steered by ICAROUS is predicted to fly straight on for this long [s]."""


class Followed(NamedTuple):
    """A route as received, and the vehicle's arc length on it at the last heartbeat [m]."""

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
    """The routes with progress, and the intruders, each with its predicted path if it keeps to its route.

    before, courses: the result and everybody's courses at the last heartbeat; beat_s: heartbeat [s]; until_s:
    legs that begin later than this are not needed [s from now].
    """
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
            # on a new connection its progress is unknown
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
    """The intruders with the paths that `with_ways` limited to until_s extended to the end of their routes."""
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
    """Radius around the end of its route that contains a vehicle circling there, assuming the own bank angle
    [m].
    """
    speed = _speed_m_s(other)
    tightest_m = speed / _turn_rate(other, sensed)
    return 2 * TURN_MARGIN * tightest_m + TRACKING_S * speed


def _turn_rate(other: Intruder, sensed: Sensed) -> float:
    """Turn rate of another vehicle, assuming the own bank angle [rad/s]."""
    return sensed.ability.turn_rate_rad_s * sensed.motion.speed_m_s / _speed_m_s(other)


def _steered(
    other: Intruder, to: Velocity, was_rad: float | None, sensed: Sensed, beat_s: float
) -> Intruder:
    """A vehicle predicted to turn to the announced velocity and then fly straight on, assuming the own bank
    angle; unchanged if it is neither at that course nor turning towards it. was_rad: its course a
    heartbeat ago.
    """
    speed, v = _speed_m_s(other), other.velocity
    course, goal = _course_rad(v), _course_rad(to)
    if not speed:
        return other
    if was_rad is not None:
        left = abs(smallest_turn(course, goal))
        nearer = max(0.0, abs(smallest_turn(was_rad, goal)) - left)
        # neither there nor turning there: it does not fly what was announced
        if turns(left, TURNING_RAD_S, beat_s) and not turns(nearer, TURNING_RAD_S, beat_s):
            return other
    own = sensed.ability
    ability = own._replace(turn_rate_rad_s=_turn_rate(other, sensed))
    now = Motion(other.position, course, speed, -v.down_m_s)
    # limited to the speeds and climb rates of either vehicle, whatever was announced
    low, high = min(own.min_speed_m_s, speed), max(own.max_speed_m_s, speed)
    most = max(own.max_climb_m_s, abs(v.down_m_s))
    speed, climb = min(max(math.hypot(*to[:2]), low), high), min(max(-to.down_m_s, -most), most)
    way = fly_to(now, ability, goal, speed, climb, ALWAYS_S, ALWAYS_S)
    return other._replace(way=way)


def _course_rad(v: Velocity) -> float:
    return math.atan2(v.east_m_s, v.north_m_s)


Timed = tuple[Velocity, float, float, float, float]
"""A leg at some speed: its velocity, how long it is flown [s], and the changes to north, east and up by then [m]."""
MOST_TIMED = 500
_timed: dict[tuple[int, float], tuple[Track, list[Timed | None]]] = {}
"""Legs of routes by identity of the route and speed: at each heartbeat the same legs are flown again."""


def _legs_at(track: Track, speed: float) -> list[Timed | None]:
    """The legs of a track at a speed, as far as they are known; to be filled in. Empty the first time: a speed that is
    sensed is hardly ever asked for again.
    """
    known = _timed.get((id(track), speed))
    if known is None or known[0] is not track:
        if len(_timed) >= MOST_TIMED:
            del _timed[next(iter(_timed))]
        _timed[id(track), speed] = track, []
        return []
    legs = known[1]
    if not legs:
        legs += [None] * len(track.directions)
    return legs


def _along(
    track: Track, at_m: float, other: Intruder, until_s: float = math.inf
) -> tuple[Piece, ...]:
    """Flight along a track from at_m on at the present speed, offset by the vehicle's present deviation. Legs
    that begin later than until_s [s] are omitted.
    """
    speed, pieces = _speed_m_s(other), list[Piece]()
    if not speed:
        return ()
    (north_m, east_m, alt_m), t_s, first = other.position, 0.0, bisect_right(track.s_m, at_m)
    last = min(bisect_right(track.s_m, at_m + until_s * speed), len(track.s_m) - 1)
    legs = _legs_at(track, speed)
    # as Piece(...) and so on, in a third of the time: a path of many legs is made at each heartbeat
    new = tuple.__new__
    points, s_m, directions = track.points, track.s_m, track.directions
    for k in range(first - 1, last):
        whole = k >= first  # the first leg has begun
        timed = legs[k] if legs and whole else None
        if timed is None:
            a, b, (north, east) = points[k], points[k + 1], directions[k]
            flown_s = (s_m[k + 1] - (s_m[k] if whole else at_m)) / speed
            leg_s = math.hypot(b[0] - a[0], b[1] - a[1]) / speed
            v = new(Velocity, (north * speed, east * speed, (a[2] - b[2]) / leg_s))
            timed = v, flown_s, v[0] * flown_s, v[1] * flown_s, -(v[2] * flown_s)
            if legs and whole:
                legs[k] = timed
        v, flown_s, north, east, up = timed
        pieces.append(new(Piece, (t_s, flown_s, new(Position, (north_m, east_m, alt_m)), v)))
        north_m, east_m, alt_m, t_s = north_m + north, east_m + east, alt_m + up, t_s + flown_s
    return tuple(pieces)
