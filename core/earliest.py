"""The earliest schedule of given chains: arrivals, waiting in whole laps, and constraint rows.

Lower bounds of start times only ever rise, so the iteration is monotone; it ends because a
feasible schedule needs a bounded number of rounds and every further one is refused. A wait is
none at all, or long enough for at least one lap of the loiter circle. The result is checked by
the proved kernels (`schedule_holds`) by whoever uses it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cratous.core.kernel import driver
from cratous.core.timing import row_holds, schedule_holds
from cratous.spec.plan import Row
from cratous.spec.schedule import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
)

DEPTH = 200
"""How many choices of who ends late may stack up before the rows are called impossible."""


class Visit(NamedTuple):
    """One task in a chain. Times in ms.

    previous: index of the visit that the vehicle makes before, or -1; ready_ms: when a vehicle
    without a previous visit sets off; travel_ms, duration_ms; lap_ms: shortest lap of the hold;
    lap_max_ms: longest lap (0: the vehicle cannot hold there); fixed_ms: the start, if the task
    has already been flown.
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
    """Arrival, start and end per visit; `violated` is the row that cannot be met, if any."""

    arrive_ms: tuple[int, ...]
    start_ms: tuple[int, ...]
    end_ms: tuple[int, ...]
    violated: Row | None = None


def next_wait_ms(wait_ms: int, lap_ms: int, lap_max_ms: int) -> int | None:
    """The shortest possible wait of at least wait_ms: a whole number of equal laps; None: none."""
    if wait_ms <= 0:
        return 0
    if lap_max_ms <= 0:
        return None
    laps = -(-wait_ms // lap_max_ms)
    return max(wait_ms, laps * lap_ms)


def reference_ms(row: Row, starts: dict[int, int], ends: dict[int, int]) -> int | None:
    """Latest end (kinds 1, 3) or earliest start (2, 4) of the row's group; None if not all known."""
    known = starts if row.kind in (AFTER_START, WITHIN_START) else ends
    times = [known[task] for task in row.group if task in known]
    if row.kind in (NOT_BEFORE, NOT_AFTER):
        return 0
    if len(times) < len(row.group) or not times:
        return None
    return min(times) if row.kind in (AFTER_START, WITHIN_START) else max(times)


def rows_hold(rows: Sequence[Row], starts: dict[int, int], ends: dict[int, int]) -> bool:
    """Whether all rows hold, by the proved fold; a row about an unknown task does not hold."""
    items = []
    for row in rows:
        reference = reference_ms(row, starts, ends)
        if row.i not in starts or reference is None:
            return False
        items.append((row.kind, starts[row.i], ends[row.i], reference, row.lo, row.hi))
    return bool(schedule_holds(items))


def first_broken_row(
    rows: Sequence[Row], starts: dict[int, int], ends: dict[int, int]
) -> Row | None:
    """The first row that does not hold by the proved kernel, or None."""
    for row in rows:
        reference = reference_ms(row, starts, ends)
        if row.i not in starts or reference is None:
            return row
        if not row_holds(row.kind, starts[row.i], ends[row.i], reference, row.lo, row.hi):
            return row
    return None


class _Raiser:
    """Start times that only rise, until every rule is met or one is seen to be impossible."""

    def __init__(self, visits: Sequence[Visit], rows: Sequence[Row]) -> None:
        self.visits, self.rows = visits, rows
        self.index = {visit.task_id: k for k, visit in enumerate(visits)}
        self.start = [visit.fixed_ms or 0 for visit in visits]
        self.arrive = [visit.fixed_ms or 0 for visit in visits]

    def copy(self) -> _Raiser:
        other = _Raiser(self.visits, self.rows)
        other.start, other.arrive = list(self.start), list(self.arrive)
        return other

    def end(self, k: int) -> int:
        return self.start[k] + self.visits[k].duration_ms

    def fly(self, in_laps: bool) -> tuple[bool, Row | None]:
        """Bring arrivals up to date, and waits to whole laps; (changed, impossible row)."""
        changed = False
        for k, visit in enumerate(self.visits):
            if visit.fixed_ms is not None:
                continue
            leave = visit.ready_ms if visit.previous < 0 else self.end(visit.previous)
            self.arrive[k] = leave + visit.travel_ms
            wait = max(0, self.start[k] - self.arrive[k])
            if in_laps or visit.lap_max_ms <= 0:
                whole = next_wait_ms(wait, visit.lap_ms, visit.lap_max_ms)
                if whole is None and visit.previous >= 0:
                    # no room to hold here: the vehicle waits before the task before instead
                    before = self.visits[visit.previous]
                    if before.fixed_ms is None:
                        self.start[visit.previous] += wait
                        return True, None
                if whole is None:
                    text = f"task {visit.task_id} would have to wait, but there is no room to hold"
                    return changed, Row(NOT_AFTER, visit.task_id, (), 0, 0, text)
                wait = whole
            if self.arrive[k] + wait != self.start[k]:
                self.start[k], changed = self.arrive[k] + wait, True
        return changed, None

    def raise_to(self, task_id: int, start_ms: int) -> bool | None:
        """Raise a start; True if it rose, False if it stood there already, None if it is fixed."""
        k = self.index[task_id]
        if self.start[k] >= start_ms:
            return False
        if self.visits[k].fixed_ms is not None:
            return None
        self.start[k] = start_ms
        return True

    def times(self) -> tuple[dict[int, int], dict[int, int]]:
        starts = {visit.task_id: self.start[k] for k, visit in enumerate(self.visits)}
        return starts, {visit.task_id: self.end(k) for k, visit in enumerate(self.visits)}

    def obey(self, row: Row) -> tuple[bool, list[tuple[int, int]]] | None:
        """Raise what one row raises; (changed, choices of (task, start)), or None if impossible."""
        starts, ends = self.times()
        reference = reference_ms(row, starts, ends)
        if row.i not in starts or reference is None:
            return None
        if row_holds(row.kind, starts[row.i], ends[row.i], reference, row.lo, row.hi):
            return False, []
        if row.kind in (AFTER_END, AFTER_START, NOT_BEFORE):
            rose = self.raise_to(row.i, reference + row.lo)
            return None if rose is None else (True, [])
        if row.kind == WITHIN_START:
            # the earliest start counts, so every member has to move
            moved = [self.raise_to(task, ends[row.i] - row.hi) for task in row.group]
            return None if None in moved else (True, [])
        if row.kind == WITHIN_END:
            need = ends[row.i] - row.hi
            choices = [
                (task, need - self.visits[self.index[task]].duration_ms)
                for task in sorted(row.group, key=lambda task: (-ends[task], task))
                if self.visits[self.index[task]].fixed_ms is None
            ]
            if len(choices) > 1:
                return False, choices
            return (True, []) if choices and self.raise_to(*choices[0]) else None
        return None


def _settle(
    raiser: _Raiser, in_laps: bool, budget: list[int], depth: int = 0
) -> tuple[_Raiser, Row | None]:
    """Raise until nothing changes; choices are tried depth first within the budget of rounds."""
    while True:
        budget[0] -= 1
        changed, impossible = raiser.fly(in_laps)
        if impossible is not None:
            return raiser, impossible
        for row in raiser.rows:
            answer = raiser.obey(row)
            if answer is None:
                return raiser, row
            if (budget[0] <= 0 and (answer[0] or answer[1])) or depth > DEPTH:
                return raiser, row
            if answer[0]:
                changed = True
                break
            if answer[1]:
                failed: tuple[_Raiser, Row | None] = (raiser, row)
                for task, start in answer[1]:
                    trial = raiser.copy()
                    if trial.raise_to(task, start):
                        failed = _settle(trial, in_laps, budget, depth + 1)
                        if failed[1] is None:
                            return failed
                return failed[0], row
        if not changed:
            return raiser, None


@driver(checked_by=("schedule_holds", "row_holds"))
def earliest(visits: Sequence[Visit], rows: Sequence[Row]) -> Times:
    """The earliest schedule of the chains under the rows; `violated` set if there is none.

    Visits must stand in the order of flight within a chain. First without the rule of whole laps,
    which gives true lower bounds, then with it. Where a row bounds a task by the latest end of
    several others, each of them is tried as the one that ends late.
    """
    rounds = 50 + 8 * (len(visits) + 1) * (len(rows) + 1)
    raiser, violated = _settle(_Raiser(visits, rows), False, [rounds])
    if violated is None:
        raiser, violated = _settle(raiser, True, [rounds])
    ends = tuple(raiser.end(k) for k in range(len(visits)))
    return Times(tuple(raiser.arrive), tuple(raiser.start), ends, violated)
