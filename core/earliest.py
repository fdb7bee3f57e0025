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

from cratous.core.assignment_steps import raised
from cratous.core.kernel import driver
from cratous.core.timing import row_holds, schedule_holds
from cratous.spec.plan import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
    Row,
)


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


class _Raiser:
    """Start times that only rise, until every rule is met or one is seen to be impossible."""

    def __init__(self, visits: Sequence[Visit], rows: Sequence[Row]) -> None:
        self.visits, self.rows = visits, rows
        self.of = {visit.task_id: visit for visit in visits}
        self.start = {visit.task_id: visit.fixed_ms or 0 for visit in visits}
        self.end = {visit.task_id: (visit.fixed_ms or 0) + visit.duration_ms for visit in visits}
        self.arrive = dict(self.start)

    def copy(self) -> _Raiser:
        other = _Raiser(self.visits, self.rows)
        other.start, other.end = dict(self.start), dict(self.end)
        other.arrive = dict(self.arrive)
        return other

    def raise_to(self, task: int, start_ms: int) -> bool | None:
        """Raise a start; True if it rose, False if it stood there already, None if it is fixed."""
        if self.start[task] >= start_ms:
            return False
        if self.of[task].fixed_ms is not None:
            return None
        self.start[task] = start_ms
        self.end[task] = start_ms + self.of[task].duration_ms
        return True

    def fly(self, in_laps: bool) -> tuple[bool, Row | None]:
        """Bring arrivals up to date, and waits to whole laps; (changed, impossible row)."""
        changed = False
        for visit in self.visits:
            task = visit.task_id
            if visit.fixed_ms is not None:
                continue
            before = self.visits[visit.previous].task_id if visit.previous >= 0 else None
            leave = visit.ready_ms if before is None else self.end[before]
            self.arrive[task] = leave + visit.travel_ms
            wait = max(0, self.start[task] - self.arrive[task])
            if in_laps or visit.lap_max_ms <= 0:
                whole = next_wait_ms(wait, visit.lap_ms, visit.lap_max_ms)
                if whole is None:
                    # no room to hold here: the vehicle waits before the task before instead
                    if before is not None and self.raise_to(before, self.start[before] + wait):
                        return True, None
                    text = f"task {task} would have to wait, but there is no room to hold"
                    return changed, Row(NOT_AFTER, task, (), 0, 0, text)
                wait = whole
            changed = bool(self.raise_to(task, self.arrive[task] + wait)) or changed
        return changed, None

    def obey(self, row: Row) -> bool | list[tuple[int, int]] | None:
        """Raise what one row raises: whether anything rose, or the choices of (task, start) to
        rise, or None if the row is impossible."""
        reference = reference_ms(row, self.start, self.end)
        if row.i not in self.start or reference is None:
            return None
        if row_holds(row.kind, self.start[row.i], self.end[row.i], reference, row.lo, row.hi):
            return False
        if row.kind in (AFTER_END, AFTER_START, NOT_BEFORE):
            return self.raise_to(row.i, raised(self.start[row.i], reference, row.lo))
        need = self.end[row.i] - row.hi
        if row.kind == WITHIN_START:
            # the earliest start counts, so every member has to move
            moved = [self.raise_to(task, need) for task in row.group]
            return None if None in moved else True
        if row.kind == WITHIN_END:
            choices = [
                (task, need - self.of[task].duration_ms)
                for task in sorted(row.group, key=lambda task: (-self.end[task], task))
                if self.of[task].fixed_ms is None
            ]
            if len(choices) != 1:
                return choices or None
            return self.raise_to(*choices[0])
        return None


def _settle(raiser: _Raiser, in_laps: bool, budget: list[int]) -> tuple[_Raiser, Row | None]:
    """Raise until nothing changes; choices are tried depth first, within a budget of rounds."""
    rounds = 4 * (len(raiser.visits) + 3)
    changed = True
    while changed:
        changed, impossible = raiser.fly(in_laps)
        if impossible is not None:
            return raiser, impossible
        rounds, budget[0] = rounds - 1, budget[0] - 1
        for row in raiser.rows:
            answer = raiser.obey(row)
            if answer is None or (answer and min(rounds, budget[0]) < 0):
                # times that still rise after so many rounds rise for ever
                return raiser, row
            if isinstance(answer, list):
                failed = raiser
                for task, start in answer:
                    trial = raiser.copy()
                    if trial.raise_to(task, start):
                        failed, violated = _settle(trial, in_laps, budget)
                        if violated is None:
                            return failed, None
                return failed, row
            changed = changed or answer
    return raiser, None


@driver(checked_by=("schedule_holds", "row_holds"))
def earliest(visits: Sequence[Visit], rows: Sequence[Row]) -> Times:
    """The earliest schedule of the chains under the rows; `violated` set if there is none.

    Visits must stand in the order of flight within a chain. First without the rule of whole laps,
    which gives true lower bounds, then with it. Where a row bounds a task by the latest end of
    several others, each of them is tried as the one that ends late.
    """
    budget = [40 * (len(visits) + 3)]
    raiser, violated = _settle(_Raiser(visits, rows), False, budget)
    if violated is None:
        raiser, violated = _settle(raiser, True, budget)
    order = [visit.task_id for visit in visits]
    return Times(
        tuple(raiser.arrive[task] for task in order),
        tuple(raiser.start[task] for task in order),
        tuple(raiser.end[task] for task in order),
        violated,
    )
