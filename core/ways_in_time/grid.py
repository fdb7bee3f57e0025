"""The grid on which a way in time is searched: places, the legs between them, and how each is flown.

A state is a leg, flown halfway, with a speed; the way from one to the next leads around the corner between them by an
arc. So the grid is finite, and every way on it can be flown: gaps in heading do not occur, and a change of speed takes
as long as the acceleration needs. The first legs are reached by a turn from the present pose.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import PACED_OFF_M, Motion, Pace, way_along
from cratous.core.avoidance.prediction import Piece
from cratous.core.ways_in_time.bends import (
    Stand,
    around_corner,
    heading_of,
    lap,
    length_m,
    middle_of,
    off_arc_m,
    onto_line,
)
from cratous.core.ways_in_time.scene import Checks, slopes_ok
from cratous.spec.mission import Position, Velocity

Leg = tuple[int, int]
"""From one place to another, by index. The first is RIGHT or LEFT after the first turn."""
GOAL = 0
"""Index of the goal among the places."""
RIGHT, LEFT, HERE = -1, -2, -3
START, END = (HERE, HERE), (GOAL, GOAL)
SIDES = ((RIGHT, 1), (LEFT, -1))
DEGREE = 8
"""Each place is joined with this many of the nearest places in sight, and with the goal if that is in sight; without
traffic, where instants make no difference, with all in sight.
"""
FIRST = 16
"""A first turn leads to so many places over which the way is shortest, and to so many of the nearest."""
NEAREST_M = 1.0
"""Places nearer to each other than this are not joined [m]."""


class Craft(NamedTuple):
    """What the vehicle can fly: ground speeds, the preferred first [m/s]; the lateral acceleration of its turns
    [m/s2]; acceleration [m/s2]; climb and descent [m/s].
    """

    speeds_m_s: tuple[float, ...]
    lateral_m_s2: float
    acceleration_m_s2: float
    max_climb_m_s: float

    def radius_m(self, speed_m_s: float) -> float:
        """Radius of a turn at a speed [m]."""
        return speed_m_s * speed_m_s / self.lateral_m_s2


class Stretch(NamedTuple):
    """From one state to the next: segments of flight timed from 0, their duration [s] and length [m], the chords that
    are not part of a leg of the grid, and bounds on the deviation: from the segments at one instant, and of arcs from
    chords [m].
    """

    pieces: tuple[Piece, ...]
    duration_s: float
    length_m: float
    chords: tuple[Position, ...]
    rho_m: float
    off_m: float

    def begun(self, at_s: float) -> tuple[Piece, ...]:
        """The segments if it begins at an instant [s]."""
        return tuple(p._replace(start_s=p.start_s + at_s) for p in self.pieces)


@dataclass
class Grid:
    """The grid from a present motion over places, the goal first. checks: of legs against zones, counted."""

    now: Motion
    places: tuple[Position, ...]
    craft: Craft
    checks: Checks
    _near: dict[int, tuple[int, ...]] = field(default_factory=dict)
    _stands: dict[Leg, Stand | None] = field(default_factory=dict)
    _made: dict[tuple[Leg, Leg, float, float, int], Stretch | None] = field(default_factory=dict)
    _kept: dict[tuple[Leg, Leg, float, float, int], bool] = field(default_factory=dict)

    def near(self, i: int) -> tuple[int, ...]:
        """The places joined with a place by a leg that keeps the zones, the nearest first."""
        if i not in self._near:
            p, found = self.places[i], list[int]()
            order = sorted(range(len(self.places)), key=lambda j: (_far(p, self.places[j]), j))
            for j in order:
                enough = bool(self.checks.scene.intruders) and len(found) >= DEGREE
                if (enough and j != GOAL) or not self._joined(i, j):
                    continue
                found.append(j)
            self._near[i] = tuple(found)
        return self._near[i]

    def _joined(self, i: int, j: int) -> bool:
        p, q = self.places[i], self.places[j]
        if i == j or _far(p, q) < NEAREST_M:
            return False
        slowest = min(self.craft.speeds_m_s)
        if not slopes_ok((p, q), slowest, self.craft.max_climb_m_s):
            return False
        # one order, so that a leg and its reverse are one check
        return self.checks.keeps_zones(min(p, q), max(p, q))

    def legs(self) -> int:
        """Number of legs in the grid, where all places have been looked at."""
        return sum(len(self.near(i)) for i in range(len(self.places)))

    @cached_property
    def left_m(self) -> list[float]:
        """For each place the length of the shortest chain of legs to the goal [m]; infinite without one."""
        back: list[list[int]] = [[] for _ in self.places]
        for i in range(len(self.places)):
            for j in self.near(i):
                back[j].append(i)
        left = [math.inf] * len(self.places)
        left[GOAL] = 0.0
        heap = [(0.0, GOAL)]
        while heap:
            so_far, j = heapq.heappop(heap)
            if so_far > left[j]:
                continue
            for i in back[j]:
                longer = so_far + _far(self.places[i], self.places[j])
                if longer < left[i]:
                    left[i] = longer
                    heapq.heappush(heap, (longer, i))
        return left

    def after(self, leg: Leg) -> Iterator[Leg]:
        """The states that may follow one, without laps."""
        if leg == START:
            yield from ((side, j) for j in self._first() for side, _ in SIDES)
        elif leg[1] == GOAL:
            yield END
        else:
            yield from ((leg[1], j) for j in self.near(leg[1]) if j != leg[0])

    def _first(self) -> list[int]:
        """The places to which a first turn leads: those over which the way is shortest, and the nearest."""
        here, left, rest = self.now.position, self.left_m, range(1, len(self.places))
        away = {j: _far(here, self.places[j]) for j in rest}
        short = sorted(rest, key=lambda j: (away[j] + left[j], j))[:FIRST]
        near = sorted(rest, key=lambda j: (away[j], j))[:FIRST]
        return list(dict.fromkeys((GOAL, *short, *near)))

    def stand(self, leg: Leg, speed_m_s: float) -> Stand | None:
        """Where a state is: halfway along its leg, or where the first turn ends; None if that turn is not possible."""
        if leg == START:
            return Stand(self.now.position, self.now.heading_rad, 0.0)
        if leg[0] >= 0:
            if leg not in self._stands:
                self._stands[leg] = middle_of(self.places[leg[0]], self.places[leg[1]])
            return self._stands[leg]
        first = self.stretch(START, leg, self.now.speed_m_s, speed_m_s)
        if first is None:
            return None
        turned, to = first.chords[-2:]
        return Stand(turned, heading_of(turned, to), length_m((turned, to)))

    def stretch(
        self, leg: Leg, to: Leg, speed_m_s: float, to_m_s: float, side: int = 0
    ) -> Stretch | None:
        """From one state to the next with a change of speed, or a lap to a side; None if that cannot be flown."""
        key = leg, to, speed_m_s, to_m_s, side
        if key not in self._made:
            self.checks.calls += 1
            self._made[key] = self._stretch(*key)
        return self._made[key]

    def _stretch(
        self, leg: Leg, to: Leg, speed_m_s: float, to_m_s: float, side: int
    ) -> Stretch | None:
        craft, stand = self.craft, self.stand(leg, speed_m_s)
        fast = max(speed_m_s, to_m_s)
        radius_m = craft.radius_m(fast)
        points: tuple[Position, ...] | None
        if stand is None:
            return None
        if side:
            points = lap(stand, side, radius_m)
        elif to == END:
            points = (stand.position, self.places[GOAL])
        elif leg == START:
            points = onto_line(stand, self.places[to[1]], dict(SIDES)[to[0]], radius_m)
        else:
            points = around_corner(stand, self.places[leg[1]], self.places[to[1]], radius_m)
        if points is None or not slopes_ok(points, fast, craft.max_climb_m_s):
            return None
        change_m = abs(to_m_s**2 - speed_m_s**2) / 2
        if change_m > craft.acceleration_m_s2 * length_m(points):
            return None
        rho_m = off_m = off_arc_m(radius_m)
        if to_m_s == speed_m_s:
            pieces = _at_one_speed(points, speed_m_s)
        else:
            now = Motion(stand.position, stand.heading_rad, speed_m_s, 0.0)
            pace = Pace(to_m_s, craft.acceleration_m_s2)
            pieces = way_along(now, points[1:], math.inf, pace=pace).pieces
            # its last point may be left out if it is nearer than NEAREST_M
            rho_m += PACED_OFF_M + NEAREST_M
        took_s = sum(piece.duration_s for piece in pieces)
        if side or leg == START:
            chords = points if side else (*points, self.places[to[1]])
        else:
            chords = points[1:-1]
        return Stretch(pieces, took_s, length_m(points), chords, rho_m, off_m)

    def keeps_zones(
        self, leg: Leg, to: Leg, speed_m_s: float, to_m_s: float, side: int = 0
    ) -> bool:
        """Whether the stretch between two states keeps the zones."""
        key = leg, to, speed_m_s, to_m_s, side
        if key not in self._kept:
            made = self.stretch(*key)
            self._kept[key] = made is not None and self.checks.line_keeps_zones(
                made.chords, made.off_m
            )
        return self._kept[key]


def _at_one_speed(points: tuple[Position, ...], speed_m_s: float) -> tuple[Piece, ...]:
    """The segments of a polyline flown at one ground speed."""
    pieces, at_s = list[Piece](), 0.0
    for p, q in itertools.pairwise(points):
        took_s = _far(p, q) / speed_m_s
        if took_s > 0:
            north, east, up = ((b - a) / took_s for a, b in zip(p, q, strict=True))
            pieces.append(Piece(at_s, took_s, p, Velocity(north, east, -up)))
            at_s += took_s
    return tuple(pieces)


def _far(p: Position, q: Position) -> float:
    return math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
