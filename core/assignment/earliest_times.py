"""The earliest schedule of given chains: arrivals, waiting in whole laps, and constraint rows.

Every rule is an *edge* (one start is at least another start plus a time), a latest start, or a *choice* between
edges: which member of a group has the earliest start or the latest end, and whether a wait that is not a whole number
of laps becomes longer or shorter. Under given edges starts only increase (`raised`), so the fixed point is the
componentwise earliest schedule, and there is none if a start exceeds its latest, or increases around a cycle. Where a
choice is violated, both alternatives are tried, so the result is the best of the earliest schedules of all choices.
The result is checked by the proved kernels (`schedule_holds`, `chain_holds`) before it is returned.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cratous.core.assignment.steps import chain_holds, raised
from cratous.core.kernel import Refusal, driver
from cratous.core.schedule.rows import schedule_holds
from cratous.spec import constraint_rows as kinds
from cratous.spec.constraint_rows import Row

CHOICES_MAX = 2_000
"""Maximum number of choices tried for one schedule."""


class Visit(NamedTuple):
    """One task in a chain. Times in ms.

    previous: index of the vehicle's preceding visit, or -1; ready_ms: when a vehicle without a preceding visit
    departs; travel_ms, duration_ms; lap_ms: shortest lap of the hold; lap_max_ms: longest lap (0: the vehicle cannot
    hold there); fixed_ms: the start, if the task has already been flown.
    """

    task_id: int
    previous: int
    travel_ms: int
    duration_ms: int
    lap_ms: int
    lap_max_ms: int
    ready_ms: int = 0
    fixed_ms: int | None = None


@dataclass(frozen=True)
class Times:
    """Arrival, start and end per visit. sure: all choices were tried, so there is no better schedule."""

    arrive_ms: tuple[int, ...]
    start_ms: tuple[int, ...]
    end_ms: tuple[int, ...]
    sure: bool = True


@dataclass(frozen=True)
class Unmet(Refusal):
    """No schedule was found: a row that cannot be satisfied. sure: all choices were tried, so there is none."""

    violated: Row
    sure: bool = True


def next_wait_ms(wait_ms: int, lap_ms: int, lap_max_ms: int) -> int | None:
    """The shortest possible wait of at least wait_ms, a whole number of equal laps; None if impossible."""
    if wait_ms <= 0:
        return 0
    if lap_max_ms <= 0:
        return None
    laps = -(-wait_ms // lap_max_ms)
    return max(wait_ms, laps * lap_ms)


def reference_ms(row: Row, starts: dict[int, int], ends: dict[int, int]) -> int | None:
    """Latest end (kinds 1, 3) or earliest start (2, 4) of the row's group; None if not all known."""
    known = starts if row.kind in (kinds.AFTER_START, kinds.WITHIN_START) else ends
    times = [known[task] for task in row.group if task in known]
    if row.kind in (kinds.NOT_BEFORE, kinds.NOT_AFTER):
        return 0
    if len(times) < len(row.group) or not times:
        return None
    return min(times) if row.kind in (kinds.AFTER_START, kinds.WITHIN_START) else max(times)


def rows_hold(rows: Sequence[Row], starts: dict[int, int], ends: dict[int, int]) -> bool:
    """Whether all rows hold, by the proved fold; a row about an unknown task does not hold."""
    items = []
    for row in rows:
        reference = reference_ms(row, starts, ends)
        if row.i not in starts or reference is None:
            return False
        items.append((row.kind, starts[row.i], ends[row.i], reference, row.lo, row.hi))
    return bool(schedule_holds(items))


class _Edge(NamedTuple):
    """The start of `to` is at least that of the visit under which the edge is stored, plus `apart` ms."""

    to: int
    apart: int
    row: Row | None


class _Choice(NamedTuple):
    """A row with a group of several tasks: one of these edges (from, edge) must hold."""

    edges: tuple[tuple[int, _Edge], ...]


class _System:
    """The edges, latest starts and choices of some chains, and the propagation of starts under them."""

    def __init__(self, visits: Sequence[Visit], rows: Sequence[Row], partial: bool) -> None:
        self.visits = visits
        self.of = {visit.task_id: k for k, visit in enumerate(visits)}
        self.edges: list[list[_Edge]] = [[] for _ in visits]
        self.first = [0] * len(visits)
        self.latest: list[tuple[int, Row | None]] = [(1 << 62, None)] * len(visits)
        self.choices: list[_Choice] = []
        self.broken: Row | None = None
        for k, visit in enumerate(visits):
            self._visit(k, visit)
        for row in rows:
            if row.i in self.of and all(task in self.of for task in row.group):
                self._row(row, self.of[row.i], [self.of[task] for task in row.group])
            elif not partial:
                self.broken = row

    def _visit(self, k: int, visit: Visit) -> None:
        if visit.fixed_ms is not None:
            self.first[k], self.latest[k] = visit.fixed_ms, (visit.fixed_ms, None)
            return
        text = f"task {visit.task_id} would have to wait, but there is no room to hold"
        full = Row(kinds.NOT_AFTER, visit.task_id, (), 0, 0, text)
        if visit.previous < 0:
            self.first[k] = visit.ready_ms + visit.travel_ms
            if visit.lap_max_ms <= 0:
                self.latest[k] = (self.first[k], full)
            return
        way = self.visits[visit.previous].duration_ms + visit.travel_ms
        self.edges[visit.previous].append(_Edge(k, way, None))
        if visit.lap_max_ms <= 0:
            self.edges[k].append(_Edge(visit.previous, -way, full))

    def _row(self, row: Row, i: int, group: list[int]) -> None:
        long = self.visits[i].duration_ms
        if row.kind == kinds.NOT_BEFORE:
            self.first[i] = max(self.first[i], row.lo)
        elif row.kind == kinds.NOT_AFTER:
            if row.hi - long < self.latest[i][0]:
                self.latest[i] = (row.hi - long, row)
        elif row.kind == kinds.AFTER_END:
            for m in group:
                self.edges[m].append(_Edge(i, self.visits[m].duration_ms + row.lo, row))
        elif row.kind == kinds.WITHIN_START:
            for m in group:
                self.edges[i].append(_Edge(m, long - row.hi, row))
        elif row.kind == kinds.AFTER_START:
            self._any([(m, _Edge(i, row.lo, row)) for m in group])
        elif row.kind == kinds.WITHIN_END:
            last = [self.visits[m].duration_ms for m in group]
            self._any(
                [(i, _Edge(m, long - row.hi - d, row)) for m, d in zip(group, last, strict=True)]
            )
        else:
            self.broken = row

    def _any(self, edges: list[tuple[int, _Edge]]) -> None:
        if len(edges) == 1:
            self.edges[edges[0][0]].append(edges[0][1])
        else:
            self.choices.append(_Choice(tuple(edges)))

    def raise_all(self, start: list[int], moved: Sequence[int]) -> Row | None:
        """Increase starts until all edges hold, beginning at the visits that have moved; a row if they cannot."""
        waiting, queued = deque(moved), [False] * len(start)
        rises, cause = [0] * len(start), [Edge0] * len(start)
        for k in moved:
            queued[k] = True
            if start[k] > self.latest[k][0]:
                return self.latest[k][1] or _unnamed(self.visits[k])
        while waiting:
            k = waiting.popleft()
            queued[k] = False
            for edge in self.edges[k]:
                new = raised(start[edge.to], start[k], edge.apart)
                if new == start[edge.to]:
                    continue
                start[edge.to] = new
                cause[edge.to] = (k, edge.row)
                rises[edge.to] += 1
                late, why = self.latest[edge.to]
                if new > late or rises[edge.to] > len(start) * len(start):
                    return (why if new > late else None) or self._blame(cause, edge.to)
                if rises[edge.to] > len(start) and self._circle(cause, edge.to):
                    return self._blame(cause, edge.to)
                if not queued[edge.to]:
                    queued[edge.to] = True
                    waiting.append(edge.to)
        return None

    def _circle(self, cause: list[tuple[int, Row | None]], k: int) -> bool:
        """Whether the causes of an increase form a cycle."""
        seen = set()
        while k >= 0 and k not in seen:
            seen.add(k)
            k = cause[k][0]
        return k >= 0

    def _blame(self, cause: list[tuple[int, Row | None]], k: int) -> Row:
        """The nearest row among the causes of an increase."""
        at, seen = k, set()
        while at >= 0 and at not in seen:
            seen.add(at)
            at, row = cause[at]
            if row is not None:
                return row
        return _unnamed(self.visits[k])

    def ways_out(self, start: list[int]) -> list[tuple[int, _Edge]] | None:
        """The edges of which one has to be added, in order of the increase they cause; None if no
        choice is violated.
        """
        for choice in self.choices:
            if all(start[edge.to] < start[k] + edge.apart for k, edge in choice.edges):
                return sorted(choice.edges, key=lambda c: start[c[0]] + c[1].apart - start[c[1].to])
        for k, visit in enumerate(self.visits):
            if visit.fixed_ms is not None or visit.lap_max_ms <= 0:
                continue
            wait = start[k] - self.arrival(start, k)
            laps = -(-wait // visit.lap_max_ms)
            if wait == 0 or wait >= laps * visit.lap_ms:
                continue
            way = visit.travel_ms
            if visit.previous < 0:
                # the alternative with the shorter wait is excluded: the vehicle departs when ready
                return [(-1, _Edge(k, visit.ready_ms + way + laps * visit.lap_ms, None))]
            way += self.visits[visit.previous].duration_ms
            longer = _Edge(k, way + laps * visit.lap_ms, None)
            shorter = _Edge(visit.previous, -way - (laps - 1) * visit.lap_max_ms, None)
            return [(visit.previous, longer), (k, shorter)]
        return None

    def arrival(self, start: list[int], k: int) -> int:
        """The arrival time [ms]."""
        visit = self.visits[k]
        if visit.fixed_ms is not None:
            return visit.fixed_ms
        if visit.previous < 0:
            return visit.ready_ms + visit.travel_ms
        before = self.visits[visit.previous]
        return start[visit.previous] + before.duration_ms + visit.travel_ms


Edge0: tuple[int, Row | None] = (-1, None)


def _unnamed(visit: Visit) -> Row:
    text = f"task {visit.task_id} cannot be flown so early"
    return Row(kinds.NOT_AFTER, visit.task_id, (), 0, 0, text)


Cost = Callable[[list[int]], int]


def latest_end(visits: Sequence[Visit]) -> Cost:
    """The cost function that is the latest end."""
    return lambda start: max(
        (s + v.duration_ms for s, v in zip(start, visits, strict=True)), default=0
    )


class _Best:
    """Depth-first search through the choices; keeps the best schedule below the limit."""

    def __init__(self, system: _System, cost: Cost, limit: int, effort: int) -> None:
        self.system, self.cost, self.limit, self.effort = system, cost, limit, effort
        self.best: list[int] | None = None
        self.violated: Row | None = None

    def search(self, start: list[int], moved: Sequence[int]) -> None:
        """Try all alternatives from here; `start` is changed."""
        todo: list[tuple[list[int], Sequence[int], int, tuple[int, _Edge] | None]]
        todo = [(start, moved, 0, None)]
        added: list[int] = []
        while todo:
            start, moved, depth, choice = todo.pop()
            while len(added) > depth:
                self.system.edges[added.pop()].pop()
            self.effort -= 1
            if self.effort < 0:
                return
            if choice is not None:
                k, edge = choice
                self.system.edges[k].append(edge)
                added.append(k)
                moved = (k,)
            violated = self.system.raise_all(start, moved)
            if violated is not None:
                self.violated = self.violated or violated
                continue
            if self.cost(start) >= self.limit:
                continue
            ways = self.system.ways_out(start)
            if ways is None:
                self.best, self.limit = start, self.cost(start)
            elif ways[0][0] < 0:
                # no choice: the start itself is later
                start[ways[0][1].to] = ways[0][1].apart
                todo.append((start, (ways[0][1].to,), len(added), None))
            else:
                todo += [(list(start), (), len(added), way) for way in reversed(ways)]
        while added:
            self.system.edges[added.pop()].pop()


@driver(checked_by=("schedule_holds", "chain_holds", "row_holds"))
def earliest(
    visits: Sequence[Visit],
    rows: Sequence[Row],
    cost: Cost | None = None,
    limit: int = 1 << 62,
    effort: int = CHOICES_MAX,
) -> Times | Unmet:
    """The best schedule of the chains under the rows, or a row that cannot be satisfied.

    Visits must be in the order of flight within a chain. cost: a function of the starts that does not decrease in
    them (the latest end if None); limit: only schedules that cost less count; effort: number of choices to try. A row
    about an unknown task cannot be satisfied.
    """
    system = _System(visits, rows, False)
    best = _Best(system, cost or latest_end(visits), limit, effort)
    if system.broken is None:
        best.search(list(system.first), range(len(visits)))
    found = None if best.best is None else _times(system, best)
    if found is not None and keeps(found, visits, rows):
        return found
    return Unmet(system.broken or best.violated or _none_below(limit), best.effort >= 0)


def _times(system: _System, best: _Best) -> Times:
    assert best.best is not None
    start, visits = best.best, system.visits
    arrive = tuple(system.arrival(start, k) for k in range(len(visits)))
    ends = tuple(s + v.duration_ms for s, v in zip(start, visits, strict=True))
    return Times(arrive, tuple(start), ends, best.effort >= 0)


def keeps(times: Times, visits: Sequence[Visit], rows: Sequence[Row]) -> bool:
    """Whether these times of the visits satisfy all rows, and each chain can be flown at them."""
    starts = {visit.task_id: s for s, visit in zip(times.start_ms, visits, strict=True)}
    ends = {visit.task_id: e for e, visit in zip(times.end_ms, visits, strict=True)}
    chains = list(_legs(times, visits))
    if sum(map(len, chains)) != len(visits):
        return False  # two visits claim to come after one
    return rows_hold(rows, starts, ends) and all(chain_holds(legs) for legs in chains)


def _legs(times: Times, visits: Sequence[Visit]) -> Iterator[list[tuple[int, int, int, int]]]:
    """For each chain the (travel, start, end, duration) of its visits; visits already flown keep their times."""
    next_of = {visit.previous: k for k, visit in enumerate(visits) if visit.previous >= 0}
    for first, visit in enumerate(visits):
        if visit.previous >= 0:
            continue
        legs, k, way = [], first, visit.ready_ms
        while k >= 0:
            one = visits[k]
            start = times.start_ms[k]
            travel = start if one.fixed_ms is not None else way + one.travel_ms
            legs.append((travel, start, times.end_ms[k], one.duration_ms))
            k, way = next_of.get(k, -1), 0
        yield legs


def _none_below(limit: int) -> Row:
    return Row(kinds.NOT_AFTER, 0, (), 0, limit, "no schedule costs less")


def least_starts(visits: Sequence[Visit], rows: Sequence[Row]) -> list[int] | None:
    """Lower bounds of the starts of all tasks in any schedule of the chains, whatever is chosen.

    Rows about unknown tasks are ignored. None: there is no schedule.
    """
    system = _System(visits, rows, True)
    start = list(system.first)
    if system.broken is not None or system.raise_all(start, range(len(visits))) is not None:
        return None
    return start
