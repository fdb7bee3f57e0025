"""A* over a grid of legs and time, with bounds on work and memory, and three answers.

Order: the time flown and the rest along the legs at the preferred speed, which counts ASIDE times;
a stretch that is
flown faster counts as if it were not, and any speed but the preferred one FROWNED times, so that other speeds are
flown where they are needed. A stretch is checked against zones and traffic only when its state is taken from the queue. Of states of one leg and speed
within `bin_s` the first is kept. Nothing depends on a clock: the budget is a number of checks (`Checks.calls`) and of
states. `overdue` may end a search as well, which the answer says.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.core.avoidance.prediction import Piece, after
from cratous.core.ways_in_time.grid import END, SIDES, START, Grid, Leg
from cratous.core.ways_in_time.scene import Checks

FOUND, EXHAUSTED, SPENT, FULL, OVERDUE, REFUSED = 0, 1, 2, 3, 4, 5
"""How a search ends: a way; all states of the grid looked at; the checks, or the states, of the budget used; ended by
`overdue`; the whole way refused by the final check.
"""
ASIDE, SHARE = (1.05, 3.0), (0.3, 1.0)
"""Factors of the rest of a way in the order of search, and up to which share of the budget each is used: near the
shortest first (the shortest itself without traffic), then whatever leads on.
"""
FROWNED = 1.02
"""Factor of time at another speed than the preferred one."""


class Budget(NamedTuple):
    """The greatest number of checks, and of states in memory; the horizon of a way, and by what time states of one leg
    and speed are told apart [s].
    """

    calls: int
    states: int
    horizon_s: float
    bin_s: float


class Found(NamedTuple):
    """How the search ended; segments of the way, timed from 0; bound on the deviation from them [m]; the greatest
    number of states in memory.
    """

    end: int
    pieces: tuple[Piece, ...]
    rho_m: float
    states: int


class _State(NamedTuple):
    """A state of flight: leg, speed [m/s], instant [s], the state before, the side of a lap flown to it, or 0, and what
    counts for the order so far [s].
    """

    leg: Leg
    speed_m_s: float
    at_s: float
    before: _State | None
    side: int
    cost_s: float = 0.0


@dataclass
class Search:
    """One search. grid: finite; budget: as above; overdue: asked at each state."""

    grid: Grid
    budget: Budget
    overdue: Callable[[], bool] | None = None
    _heap: list[tuple[float, float, int, _State]] = field(default_factory=list)
    _closed: set[tuple[Leg, float, int]] = field(default_factory=set)
    _count: int = 0
    _most: int = 0

    def run(self) -> Found:
        """Search until a way is found, the grid is exhausted, or the budget is."""
        self._timed = bool(self.grid.checks.scene.intruders)
        found = self._ended(SPENT)
        for aside, share in zip(ASIDE, SHARE, strict=True):
            self._aside = aside if self._timed or share == 1.0 else 1.0
            found = self._searched(math.floor(share * self.budget.calls))
            if found.end != SPENT:
                break
        return found

    def _searched(self, calls: int) -> Found:
        """One search, from the beginning."""
        self._heap, self._closed = [], set()
        first = _State(START, self.grid.now.speed_m_s, 0.0, None, 0)
        heapq.heappush(self._heap, (0.0, 0.0, 0, first))
        while self._heap:
            checks = self.grid.checks
            if checks.calls > calls:
                return self._ended(SPENT)
            if len(self._heap) + len(self._closed) > self.budget.states:
                return self._ended(FULL)
            if self.overdue is not None and self.overdue():
                return self._ended(OVERDUE)
            self._most = max(self._most, len(self._heap) + len(self._closed))
            state = heapq.heappop(self._heap)[-1]
            checks.calls += 1
            key = self._key(state)
            if key in self._closed or not self._permitted(state):
                continue
            self._closed.add(key)
            if state.leg == END:
                return self._whole(state)
            self._expand(state)
        return self._ended(EXHAUSTED)

    def _ended(self, end: int) -> Found:
        return Found(end, (), 0.0, self._most)

    def _key(self, state: _State) -> tuple[Leg, float, int]:
        number = math.floor(state.at_s / self.budget.bin_s) if self._timed else 0
        return state.leg, state.speed_m_s, number

    def _permitted(self, state: _State) -> bool:
        """Whether the stretch to a state keeps zones and traffic."""
        before = state.before
        if before is None:
            return True
        way = before.leg, state.leg, before.speed_m_s, state.speed_m_s, state.side
        made = self.grid.stretch(*way)
        if made is None or not self.grid.keeps_zones(*way):
            return False
        return self.grid.checks.first_met(made.begun(before.at_s), made.rho_m) is None

    def _expand(self, state: _State) -> None:
        speeds = self.grid.craft.speeds_m_s
        for leg in self.grid.after(state.leg):
            for speed in speeds:
                self._push(state, leg, speed, 0)
        if self._timed:
            for _, side in SIDES:
                self._push(state, state.leg, state.speed_m_s, side)

    def _push(self, state: _State, leg: Leg, speed_m_s: float, side: int) -> None:
        made = self.grid.stretch(state.leg, leg, state.speed_m_s, speed_m_s, side)
        rest_m = math.inf if made is None else self._rest_m(leg, speed_m_s)
        if made is None or rest_m == math.inf:
            return
        at_s = state.at_s + made.duration_s
        speeds = self.grid.craft.speeds_m_s
        counts_s = max(made.duration_s, made.length_m / speeds[0])
        counts_s *= 1.0 if speed_m_s == speeds[0] else FROWNED
        after_it = _State(leg, speed_m_s, at_s, state, side, state.cost_s + counts_s)
        late = at_s + rest_m / max(speeds) > self.budget.horizon_s
        if late or self._key(after_it) in self._closed:
            return
        self._count += 1
        # of equal states the one farther on its way, then the one found first
        rest_s = rest_m / speeds[0]
        order = after_it.cost_s + self._aside * rest_s
        heapq.heappush(self._heap, (order, rest_s, self._count, after_it))

    def _rest_m(self, leg: Leg, speed_m_s: float) -> float:
        if leg == END:
            return 0.0
        if leg == START:
            return min(self.grid.left_m)
        stand = self.grid.stand(leg, speed_m_s)
        return math.inf if stand is None else stand.room_m + self.grid.left_m[leg[1]]

    def _whole(self, last: _State) -> Found:
        """The way to a last state, put to the kernels once more as a whole."""
        states, state = [last], last
        while state.before is not None:
            state = state.before
            states.append(state)
        states.reverse()
        pieces, rho_m = list[Piece](), 0.0
        for a, b in itertools.pairwise(states):
            made = self.grid.stretch(a.leg, b.leg, a.speed_m_s, b.speed_m_s, b.side)
            assert made is not None
            pieces += made.begun(a.at_s)
            rho_m = max(rho_m, made.rho_m)
        way = tuple(pieces)
        again = Checks(self.grid.checks.scene)
        zones = all(again.keeps_zones(p.position, after(p, p.duration_s), 0.0) for p in way)
        if not zones or again.first_met(way, rho_m) is not None:
            return self._ended(REFUSED)
        return Found(FOUND, way, rho_m, self._most)
