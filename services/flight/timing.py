"""Start and end times of tasks in flight: the rows of the plan, checked against actual times.

`starts` and `ends` map task ids to actual times [ms]. The kernels decide whether a task may start and whether
a row holds; this module adds the reference times.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cratous.core.executive.steps import all_ended_before, some_begun_before
from cratous.core.schedule.rows import row_holds
from cratous.spec.constraint_rows import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    Row,
)

Times = Mapping[int, tuple[int, int]]
"""Start and end of tasks [ms]."""

LOWER = (AFTER_END, AFTER_START, NOT_BEFORE)


def reference(row: Row, starts: Mapping[int, int], ends: Mapping[int, int]) -> int | None:
    """Latest end or earliest start of the row's group [ms]; None while it is not known. 0 for an empty group."""
    if not row.group:
        return 0
    known = ends if row.kind in (AFTER_END, WITHIN_END) else starts
    if row.kind in (AFTER_END, WITHIN_END):
        if any(task not in known for task in row.group):
            return None
        return max(known[task] for task in row.group)
    some = [known[task] for task in row.group if task in known]
    return min(some) if some else None


def closed_by(
    task_id: int,
    at_ms: int,
    rows: Iterable[Row],
    starts: Mapping[int, int],
    ends: Mapping[int, int],
) -> Row | None:
    """The first lower-bound row that forbids the task to start at an instant; None if none does."""
    for row in rows:
        if row.i == task_id and row.kind in LOWER and not _open(row, at_ms, starts, ends):
            return row
    return None


def _open(row: Row, at_ms: int, starts: Mapping[int, int], ends: Mapping[int, int]) -> bool:
    """Whether a lower-bound row permits its task to start at an instant."""
    if not row.group:
        return row_holds(row.kind, at_ms, at_ms, 0, row.lo, row.hi)
    after_end = row.kind == AFTER_END
    times = ends if after_end else starts
    group = [(task in times, times.get(task, 0)) for task in row.group]
    decide = all_ended_before if after_end else some_begun_before
    return bool(decide(group, at_ms, row.lo))


def opens_ms(
    task_id: int, rows: Iterable[Row], starts: Mapping[int, int], ends: Mapping[int, int]
) -> int:
    """The earliest start that the lower bounds allow [ms], given the (expected) times of the other tasks."""
    earliest = 0
    for row in rows:
        if row.i != task_id or row.kind not in LOWER:
            continue
        ref = reference(row, starts, ends)
        if ref is not None:
            earliest = max(earliest, ref + row.lo)
    return earliest


def broken_by(
    task_id: int,
    start_ms: int,
    end_ms: int,
    rows: Iterable[Row],
    starts: Mapping[int, int],
    ends: Mapping[int, int],
) -> Row | None:
    """The first upper-bound row that a task with these times would break; None if none."""
    for row in rows:
        if row.i != task_id or row.kind in LOWER:
            continue
        ref = 0 if row.kind == NOT_AFTER else reference(row, starts, ends)
        if ref is not None and not row_holds(row.kind, start_ms, end_ms, ref, row.lo, row.hi):
            return row
    return None
