"""When times of tasks satisfy a constraint. Milliseconds after mission start.

A task runs at every instant from its start to its end, both included. The definitions refer to instants; the kernels
(`core.schedule.rows`) to starts and ends. A definition takes the instants that it quantifies over as its first
arguments, and its docstring states how they are quantified; instants are integers. All of them use only comparisons,
`and`, `or`, `not` and `if`, so that they can be run on numbers and on symbolic values alike.

All times and bounds lie strictly between -2**61 and 2**61 (`TIME_LIMIT_MS`): the range for which the kernels are
proved, in which the sum of two stays within 64 bits.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.constraint_rows import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
)

TIME_LIMIT_MS = 2**61
"""All times and bounds are below this (73 million years). It is the premise of the proofs."""


def runs_at(t: int, start: int, end: int) -> bool:
    """The task that runs from start to end runs at the instant t."""
    return start <= t and t <= end


def not_before(t: int, start: int, end: int, bound: int) -> bool:
    """If the task runs at t then t is not before the bound. FOR ALL t."""
    return not (runs_at(t, start, end) and t < bound)


def not_after(t: int, start: int, end: int, bound: int) -> bool:
    """If the task runs at t then t is not after the bound. FOR ALL t."""
    return not (runs_at(t, start, end) and t > bound)


def row_holds(t: int, kind: int, start: int, end: int, ref: int, lo: int, hi: int) -> bool:
    """At the instant t the task does not run outside the times that the row permits.

    FOR ALL t: the row holds. Premise: start <= end (see `interval_is_ordered`), for otherwise the task runs at no
    instant and every row would hold. An unknown kind never holds.
    """
    if kind == AFTER_END:
        return not_before(t, start, end, ref + lo)
    if kind == AFTER_START:
        return not_before(t, start, end, ref + lo)
    if kind == WITHIN_END:
        return not_after(t, start, end, ref + hi)
    if kind == WITHIN_START:
        return not_after(t, start, end, ref + hi)
    if kind == NOT_BEFORE:
        return not_before(t, start, end, lo)
    if kind == NOT_AFTER:
        return not_after(t, start, end, hi)
    return False


def interval_is_ordered(t: int, u: int, start: int, end: int) -> bool:
    """The task runs at t, and if it runs at u then u is not before mission start.

    THERE IS a t such that FOR ALL u: the task runs at some instant, and at none before 0.
    """
    return runs_at(t, start, end) and not (runs_at(u, start, end) and u < 0)


def vehicle_is_eligible(k: int, mask: int, bit: int) -> bool:
    """Vehicle number k is in the set `mask` and in the set `bit` (bit k of a mask is vehicle k).

    THERE IS a k in 0..63: the vehicle whose one-bit mask is `bit` is one of the eligible ones.
    """
    return (mask >> k) & 1 == 1 and (bit >> k) & 1 == 1


def all_rows_hold(
    t: int, u: int, kind: int, start: int, end: int, ref: int, lo: int, hi: int
) -> bool:
    """One row and the interval of its task are valid, considered at the instants t and u.

    FOR ALL rows THERE IS a t such that FOR ALL u: the whole schedule holds.
    """
    return interval_is_ordered(t, u, start, end) and row_holds(u, kind, start, end, ref, lo, hi)


class Timed(NamedTuple):
    """A row with the interval of its task, its reference time and its bounds."""

    kind: int
    start: int
    end: int
    ref: int
    lo: int
    hi: int


def rows_hold_step(t: int, u: int, ok: bool, row: Timed) -> bool:
    """All rows so far held (`ok`) and this one does. THERE IS a t such that FOR ALL u."""
    return ok and all_rows_hold(t, u, row.kind, row.start, row.end, row.ref, row.lo, row.hi)


def later_of(t: int, best: int, value: int) -> bool:
    """The instant t is no later than one of the two.

    FOR ALL t: this equals `t <= m` exactly for m the later of best and value.
    """
    return t <= best or t <= value


def earlier_of(t: int, best: int, value: int) -> bool:
    """The instant t is no earlier than one of the two.

    FOR ALL t: this equals `t >= m` exactly for m the earlier of best and value.
    """
    return t >= best or t >= value


def flown_as_asked(n: int, ok: bool, least: int, most: int, times: int) -> bool:
    """All tasks so far, and one more, are done as often as required: an n-th time exists if the task must be done n
    times, and does not if it may not be done that often. FOR ALL n >= 1.
    """
    there = n <= times
    return ok and (there or n > least) and (n <= most or not there)
