"""Flyable trajectories of an aircraft, as segments of constant velocity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.avoidance.prediction import Piece, after
from cratous.spec.mission import Position, Velocity

PIECE_S = 0.5
"""Length of the segments of turns, climbs and changes of speed [s]."""


class Ability(NamedTuple):
    """Performance of an airframe: turn rate [rad/s] at its present speed, speeds [m/s], climb [m/s], acceleration
    [m/s2], the lowest altitude that a manoeuvre may use [m MSL], and the longest time for which the autopilot holds
    one heading in a turn [s].
    """

    turn_rate_rad_s: float
    min_speed_m_s: float
    max_speed_m_s: float
    max_climb_m_s: float
    acceleration_m_s2: float
    floor_m: float
    step_s: float = PIECE_S


class Motion(NamedTuple):
    """Position, heading [rad], ground speed [m/s], climb [m/s, up]."""

    position: Position
    heading_rad: float
    speed_m_s: float
    climb_m_s: float


def velocity_of(heading_rad: float, speed_m_s: float, climb_m_s: float) -> Velocity:
    """North, east, down from heading, ground speed and climb."""
    return Velocity(
        speed_m_s * math.cos(heading_rad), speed_m_s * math.sin(heading_rad), -climb_m_s
    )


def smallest_turn(from_rad: float, to_rad: float) -> float:
    """The smallest turn from one heading to another, in (-pi, pi] [rad]; positive is right."""
    turn = math.fmod(to_rad - from_rad, 2 * math.pi)
    if turn > math.pi:
        return turn - 2 * math.pi
    if turn <= -math.pi:
        return turn + 2 * math.pi
    return turn


def fly_to(
    now: Motion,
    ability: Ability,
    heading_rad: float,
    speed_m_s: float,
    climb_m_s: float,
    climb_for_s: float,
    horizon_s: float,
) -> tuple[Piece, ...]:
    """Turn to a heading and change speed as fast as possible, climb for a while, then fly straight.

    A segment of a turn flies its mean heading at the speed of the chord, so the ends of the segments lie on the arc.
    """
    pieces: list[Piece] = []
    p, heading, speed, t = now.position, now.heading_rad, now.speed_m_s, 0.0
    while t < horizon_s:
        turn = smallest_turn(heading, heading_rad)
        gap = speed_m_s - speed
        climbing = t < climb_for_s
        steady = abs(turn) < 1e-9 and abs(gap) < 1e-9
        if steady:
            duration = (climb_for_s if climbing else horizon_s) - t
            duration = min(duration, horizon_s - t)
        else:
            duration = min(PIECE_S, horizon_s - t)
        most = ability.turn_rate_rad_s * duration
        turn = min(max(turn, -most), most)
        gain = min(
            max(gap, -ability.acceleration_m_s2 * duration), ability.acceleration_m_s2 * duration
        )
        mean_speed = speed + gain / 2
        half = turn / 2
        chord = mean_speed if abs(half) < 1e-9 else mean_speed * math.sin(half) / half
        climb = climb_m_s if climbing else 0.0
        piece = Piece(t, duration, p, velocity_of(heading + turn / 2, chord, climb))
        pieces.append(piece)
        p, heading, speed, t = after(piece, duration), heading + turn, speed + gain, t + duration
    return tuple(pieces)


class Way(NamedTuple):
    """Flight through points. pieces: up to the last point, or to the horizon; beyond: straight flight from there,
    None if not all points are reached by then.
    """

    pieces: tuple[Piece, ...]
    beyond: Piece | None


class Pace(NamedTuple):
    """The final speed on a path [m/s], and the acceleration towards it [m/s2]."""

    speed_m_s: float
    acceleration_m_s2: float


def way_along(
    now: Motion,
    points: Sequence[Position],
    horizon_s: float,
    start_s: float = 0.0,
    pace: Pace | None = None,
) -> Way:
    """Fly from the present position through points at the present speed, or changing to the speed of a pace."""
    if pace is not None and pace.acceleration_m_s2 > 0 and pace.speed_m_s != now.speed_m_s:
        return _paced(now, points, horizon_s, pace)
    pieces: list[Piece] = []
    p, t, last, speed = now.position, start_s, None, now.speed_m_s
    # as Piece(...) and Velocity(...), in a third of the time: paths have many legs
    new = tuple.__new__
    for q in points:
        north, east = q[0] - p[0], q[1] - p[1]
        length = math.hypot(north, east)
        if length < 1.0:
            continue
        duration, left_s = length / speed, horizon_s - t
        up = (q[2] - p[2]) / duration
        v = new(Velocity, (north / duration, east / duration, -up))
        pieces.append(new(Piece, (t, duration if duration < left_s else left_s, p, v)))
        t += duration
        last, p = v, q
        if t >= horizon_s:
            return Way(tuple(pieces), None)
    if last is None:
        on = velocity_of(now.heading_rad, now.speed_m_s, 0.0)
    else:
        on = last._replace(down_m_s=0.0)
    return Way(tuple(pieces), Piece(t, horizon_s - t, p, on))


PACED_OFF_M = 0.5
"""Greatest deviation of a segment of a speed change [m]."""


LEAST_M = 1e-6
"""Remainder of a leg, by rounding, at which it counts as flown [m]."""


def _paced(now: Motion, points: Sequence[Position], horizon_s: float, pace: Pace) -> Way:
    """The path with a change of speed, divided into segments of constant speed."""
    pieces: list[Piece] = []
    p, t, speed = now.position, 0.0, now.speed_m_s
    north, east, up = math.cos(now.heading_rad), math.sin(now.heading_rad), 0.0
    for q in points:
        left = math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        if left < 1.0:
            continue
        north, east = (q.north_m - p.north_m) / left, (q.east_m - p.east_m) / left
        up = (q.alt_m - p.alt_m) / left
        while left > LEAST_M:
            duration, mean, speed = _changed(speed, pace, left)
            v = Velocity(mean * north, mean * east, -mean * up)
            pieces.append(Piece(t, min(duration, horizon_s - t), p, v))
            p = after(pieces[-1], duration)
            t, left = t + duration, left - mean * duration
            if t >= horizon_s:
                return Way(tuple(pieces), None)
        p = q
    return Way(
        tuple(pieces), Piece(t, horizon_s - t, p, Velocity(speed * north, speed * east, 0.0))
    )


def _changed(speed_m_s: float, pace: Pace, left_m: float) -> tuple[float, float, float]:
    """The next segment of a leg with left_m left: its duration [s], its speed, and the speed after it [m/s]."""
    gap = pace.speed_m_s - speed_m_s
    if gap == 0:
        return left_m / speed_m_s, speed_m_s, speed_m_s
    whole_s = abs(gap) / pace.acceleration_m_s2
    share = min(1.0, math.sqrt(8 * PACED_OFF_M / pace.acceleration_m_s2) / whole_s)
    to = pace.speed_m_s if share == 1.0 else speed_m_s + share * gap
    mean = (speed_m_s + to) / 2
    # the leg ends within the segment
    ends = min(1.0, left_m / (mean * share * whole_s))
    if ends == 1.0:
        return share * whole_s, mean, to
    return left_m / mean, mean, speed_m_s + ends * (to - speed_m_s)


def looked_at(way: Way, horizon_s: float) -> Way:
    """The path, cut off at horizon_s [s]."""
    pieces = tuple(
        piece
        if piece.duration_s <= horizon_s - piece.start_s
        else piece._replace(duration_s=horizon_s - piece.start_s)
        for piece in way.pieces
        if piece.start_s < horizon_s
    )
    beyond = way.beyond
    if beyond is None or beyond.start_s >= horizon_s:
        return Way(pieces, None)
    return Way(pieces, beyond._replace(duration_s=horizon_s - beyond.start_s))


def along(
    now: Motion, points: Sequence[Position], horizon_s: float, start_s: float = 0.0
) -> tuple[Piece, ...]:
    """The path through points, then straight, as segments."""
    way = way_along(now, points, horizon_s, start_s)
    return way.pieces if way.beyond is None else (*way.pieces, way.beyond)
