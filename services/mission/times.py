"""Task times checked against constraint rows by the proved kernels, for plan and flight alike.

`times` maps a task to (start, end) [ms]. Rows that name a task without times are not judged here: the caller
decides.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce

from cratous.core.kernel import qualified
from cratous.core.schedule.rows import earlier, later, row_holds, runs_forward, schedule_holds
from cratous.spec.constraint_rows import (
    AFTER_END,
    AFTER_START,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
    Row,
)
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

Times = Mapping[int, tuple[int, int]]


def reference_ms(row: Row, times: Times) -> int:
    """The reference time of a row [ms]: latest end or earliest start of its group, or 0."""
    if not row.group:
        return 0
    if row.kind in (AFTER_END, WITHIN_END):
        return reduce(later, (times[task][1] for task in row.group))
    return reduce(earlier, (times[task][0] for task in row.group))


def margin_ms(row: Row, times: Times) -> int:
    """Distance of a row from its bound [ms]; negative means violated. For display only."""
    start, end = times[row.i]
    ref = reference_ms(row, times)
    if row.kind in (AFTER_END, AFTER_START):
        return start - (ref + row.lo)
    if row.kind in (WITHIN_END, WITHIN_START):
        return ref + row.hi - end
    return start - row.lo if row.kind == NOT_BEFORE else row.hi - end


def row_verdict(row: Row, times: Times, what: str) -> Verdict:
    """The verdict of the kernel `row_holds` on one row whose tasks all have times."""
    start, end = times[row.i]
    ref = reference_ms(row, times)
    forward = runs_forward(start, end)
    good = forward and row_holds(row.kind, start, end, ref, row.lo, row.hi)
    asked = (qualified(runs_forward), qualified(row_holds))
    return Verdict(
        "G1",
        f"{what}: {row.text}",
        Outcome.HOLDS if good else Outcome.VIOLATED,
        Kind.EXACT,
        f"task {row.i} runs from {start / 1000:.3f} s to {end / 1000:.3f} s",
        time_ms=start,
        margin=margin_ms(row, times) / 1000,
        unit="s",
        checks=1,
        method="row_holds",
        kernels=asked if forward else asked[:1],
    )


def all_hold(rows: Sequence[Row], times: Times) -> bool:
    """The verdict of the schedule checker (a fold) on all rows at once."""
    items = []
    for row in rows:
        start, end = times[row.i]
        items.append((row.kind, start, end, reference_ms(row, times), row.lo, row.hi))
    return bool(schedule_holds(items))
