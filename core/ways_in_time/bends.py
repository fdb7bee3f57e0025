"""The geometry of a way over places: arcs at its corners, turns onto its first leg, and laps to wait.

A state of flight is a `Stand`: a place on a straight line, with the line ahead up to the next place. Between stands a
way is straight up to an arc that is tangent to both lines, so it has no gap in heading. Arcs are returned as chords.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import smallest_turn
from cratous.spec.mission import Position

CHORD_RAD = math.radians(15)
"""Greatest angle of an arc that one chord stands for."""
SHARPEST_RAD = math.radians(150)
"""A sharper corner than this is flown by no arc."""


class Stand(NamedTuple):
    """A place on a line: position, heading [rad], and the line still ahead up to the next place [m]."""

    position: Position
    heading_rad: float
    room_m: float


def off_arc_m(radius_m: float) -> float:
    """Greatest distance of the flight along an arc from that along its chords, at one instant [m].

    Along a chord of duration d the deviation is at most A d^2 / 8, A = v^2 / r.
    """
    return radius_m * CHORD_RAD * CHORD_RAD / 8


def length_m(points: tuple[Position, ...]) -> float:
    """Horizontal length of a polyline [m]."""
    return sum(
        math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        for p, q in itertools.pairwise(points)
    )


def heading_of(p: Position, q: Position) -> float:
    """The direction from p to q, clockwise from north [rad]."""
    return math.atan2(q.east_m - p.east_m, q.north_m - p.north_m)


def middle_of(p: Position, q: Position) -> Stand:
    """The stand halfway along the leg from p to q."""
    half = (p.north_m + q.north_m) / 2, (p.east_m + q.east_m) / 2, (p.alt_m + q.alt_m) / 2
    return Stand(Position(*half), heading_of(p, q), length_m((p, q)) / 2)


def _along(p: Position, q: Position, from_q_m: float) -> Position:
    """The place on the line from p to q that is from_q_m before q [m]."""
    whole = length_m((p, q))
    share = 1.0 if whole == 0 else max(0.0, 1 - from_q_m / whole)
    return Position(*(a + share * (b - a) for a, b in zip(p, q, strict=True)))


def _arc(
    p: Position, heading_rad: float, turn_rad: float, radius_m: float, rise_m: float
) -> list[Position]:
    """The ends of the chords of an arc from a place; turn_rad > 0 is to the right, rise_m: climb over the arc [m]."""
    side = 1.0 if turn_rad > 0 else -1.0
    north = p.north_m - side * radius_m * math.sin(heading_rad)
    east = p.east_m + side * radius_m * math.cos(heading_rad)
    count = max(1, math.ceil(abs(turn_rad) / CHORD_RAD))
    ends = []
    for k in range(1, count + 1):
        now = heading_rad + turn_rad * k / count
        ends.append(
            Position(
                north + side * radius_m * math.sin(now),
                east - side * radius_m * math.cos(now),
                p.alt_m + rise_m * k / count,
            )
        )
    return ends


def around_corner(
    stand: Stand, corner: Position, beyond: Position, radius_m: float
) -> tuple[Position, ...] | None:
    """From a stand around the corner ahead to halfway along the leg from there to `beyond`; None if an arc of the
    radius [m] finds no room.
    """
    out = middle_of(corner, beyond)
    turn = smallest_turn(stand.heading_rad, out.heading_rad)
    if abs(turn) > SHARPEST_RAD:
        return None
    room_m = radius_m * math.tan(abs(turn) / 2)
    if room_m > stand.room_m or room_m > out.room_m:
        return None
    if abs(turn) < 1e-6:
        return (stand.position, corner, out.position)
    begin, end = _along(stand.position, corner, room_m), _along(beyond, corner, room_m)
    arc = _arc(begin, stand.heading_rad, turn, radius_m, end.alt_m - begin.alt_m)
    return (stand.position, begin, *arc[:-1], end, out.position)


def onto_line(
    stand: Stand, to: Position, side: int, radius_m: float
) -> tuple[Position, ...] | None:
    """From a stand by an arc to the right (side 1) or left (-1) until the nose points at a place; None if the place
    is within the circle. The altitude stays the same.
    """
    p, heading = stand.position, stand.heading_rad
    north = p.north_m - side * radius_m * math.sin(heading)
    east = p.east_m + side * radius_m * math.cos(heading)
    far = math.hypot(to.north_m - north, to.east_m - east)
    if far <= radius_m:
        return None
    bearing = math.atan2(to.east_m - east, to.north_m - north)
    leaves = bearing - side * math.acos(radius_m / far)
    turn = math.fmod(side * (leaves - heading) + math.pi / 2, 2 * math.pi)
    turn = turn + 2 * math.pi if turn < 0 else turn
    if turn < 1e-6 or turn > 2 * math.pi - 1e-6:
        return (p,)
    return (p, *_arc(p, heading, side * turn, radius_m, 0.0))


def lap(stand: Stand, side: int, radius_m: float) -> tuple[Position, ...]:
    """A full circle to the right (side 1) or left (-1), back to the stand."""
    p = stand.position
    return (p, *_arc(p, stand.heading_rad, side * 2 * math.pi, radius_m, 0.0)[:-1], p)
