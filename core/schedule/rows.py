"""Whether times of tasks satisfy order and timing constraints. Integers, milliseconds.

Definitions, and the codes of the six kinds of row: `spec.schedule`.
"""

from cratous.core.kernel import fold, kernel


@kernel(implements="schedule.row_holds")
def row_holds(kind: int, start: int, end: int, ref: int, lo: int, hi: int) -> bool:
    """True iff one constraint row holds for a task that runs from start to end [ms].

    kind: code of `spec.schedule`; ref: latest end (kinds 1, 3) or earliest start (2, 4) of the
    reference tasks [ms]; lo, hi: bounds [ms]. An unknown kind does not hold.
    """
    if kind == 1 or kind == 2:
        return start >= ref + lo
    if kind == 3 or kind == 4:
        return end <= ref + hi
    if kind == 5:
        return start >= lo
    if kind == 6:
        return end <= hi
    return False


@kernel(implements="schedule.interval_is_ordered")
def runs_forward(start: int, end: int) -> bool:
    """True iff a task's interval is valid: it does not end before it starts, nor start before 0."""
    return start >= 0 and end >= start


@kernel(implements="schedule.vehicle_is_eligible")
def eligible(mask: int, bit: int) -> bool:
    """True iff the vehicle with this one-bit mask is among the eligible ones."""
    return mask & bit != 0


@kernel(implements="schedule.rows_hold_step")
def schedule_step(ok: bool, kind: int, start: int, end: int, ref: int, lo: int, hi: int) -> bool:
    """Add one row to whether all rows so far hold."""
    return ok and runs_forward(start, end) and row_holds(kind, start, end, ref, lo, hi)


schedule_holds = fold(
    name="schedule_holds", implements="schedule.rows_hold_step", step=schedule_step, start=True
)


@kernel(implements="schedule.later_of")
def later(best: int, value: int) -> int:
    """The later of two times: the fold step for the end of a composite."""
    return max(best, value)


@kernel(implements="schedule.earlier_of")
def earlier(best: int, value: int) -> int:
    """The earlier of two times: the fold step for the start of a composite."""
    return min(best, value)
