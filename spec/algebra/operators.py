"""What the operators of the process algebra require of their operands, at one instant or for one task.

The meaning of a term (`spec.algebra.meaning`, `spec.algebra.partial`), one operator at a time. Known of each operand:
its tasks, when those that ran did so, whether it is completely done, and whether it was done as it permits. The
definitions refer to instants and to single tasks; the kernels (`core.algebra.steps`) use earliest starts, latest ends
and bit masks. Milliseconds after mission start; instants are integers, and each definition states how they are
quantified.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.schedule import runs_at

TASK, SEQUENTIAL, TILDE, PARALLEL, ALTERNATIVE = 0, 1, 2, 3, 4
"""Node codes of a term: a task, or an operator `.` `~` `|` `+` over operands."""
UNTIMED, ABSOLUTE, RELATIVE = 0, 1, 2
"""Timing codes of a term: none, `_[t1-t2]`, `-[t1-t2]`."""


class Ran(NamedTuple):
    """What ran of a term: whether any task did, the earliest start and the latest end [ms]."""

    some: bool
    start: int
    end: int


class Seen(NamedTuple):
    """A term at an instant: whether some task of it has begun, and whether all its tasks that ran have ended."""

    begun: bool
    ended: bool


class Window(NamedTuple):
    """A time interval, both ends included [ms]."""

    first: int
    last: int


class Part(NamedTuple):
    """An operand. fits: it contains all tasks of the whole term that were begun; allowed: it was done as it permits;
    whole: all of it was done.
    """

    fits: bool
    allowed: bool
    whole: bool
    ran: Ran


# ---- which tasks ------------------------------------------------------------------------------


def stands_in(k: int, mask: int) -> bool:
    """Task number k is in the set `mask` (bit k is set)."""
    return (mask >> k) & 1 == 1


def stands_in_one_of(k: int, one: int, other: int) -> bool:
    """Task number k is in one of the two sets. FOR ALL k in 0..63."""
    return stands_in(k, one) or stands_in(k, other)


def none_beside(k: int, whole: int, part: int, begun: int) -> bool:
    """If task number k is in `whole` and was begun, it is in `part`. FOR ALL k in 0..63."""
    return not (stands_in(k, whole) and stands_in(k, begun)) or stands_in(k, part)


# ---- order ------------------------------------------------------------------------------------


def some_begun(t: int, ran: Ran) -> bool:
    """At the instant t some task of a term has begun."""
    return ran.some and ran.start <= t


def all_ended(t: int, ran: Ran) -> bool:
    """At the instant t all tasks of a term that ran have ended."""
    return not ran.some or ran.end <= t


def seen(t: int, ran: Ran) -> Seen:
    """A term at the instant t."""
    return Seen(some_begun(t, ran), all_ended(t, ran))


def seen_together(t: int, one: Ran, other: Ran) -> Seen:
    """The state of a term at the instant t."""
    begun = some_begun(t, one) or some_begun(t, other)
    return Seen(begun, all_ended(t, one) and all_ended(t, other))


def lets_begin(t: int, op: int, before_whole: bool, before: Ran, later: Ran) -> bool:
    """At the instant t, an operand has begun only if the operand before it permitted that.

    `.`: the operand before is completely done and all of it has ended; `~`: some of it has begun; other operators
    impose no order. FOR ALL t.
    """
    if not some_begun(t, later):
        return True
    if op == SEQUENTIAL:
        return before_whole and all_ended(t, before)
    if op == TILDE:
        return some_begun(t, before)
    return True


# ---- timing -----------------------------------------------------------------------------------


def inside(t: int, window: Window) -> bool:
    """The instant t lies in the window."""
    return window.first <= t and t <= window.last


def may_run(
    t: int, outer: Window, op: int, timing: int, first: bool, before: Ran, bounds: Window
) -> bool:
    """A task that has no timing constraint within its operand may run at the instant t. FOR ALL t.

    outer: where the term's own tasks may run if it has no timing; op, timing, bounds: the term's operator and timing;
    first: this is the first operand; before: what ran of the operand before it. A relative timing of `.` counts from
    the instant at which all of the operand before has ended, of `~` from the instant at which some of it has begun;
    the first operand is constrained only by `outer`.
    """
    if timing == UNTIMED:
        return inside(t, outer)
    if timing == ABSOLUTE or (op != SEQUENTIAL and op != TILDE):
        return inside(t, bounds)
    if first:
        return inside(t, outer)
    if op == SEQUENTIAL:
        long_enough = all_ended(t - bounds.first, before)
        return long_enough and not all_ended(t - bounds.last - 1, before)
    return some_begun(t - bounds.first, before) and not some_begun(t - bounds.last - 1, before)


def task_is_held(t: int, u: int, needed: bool, ran: Ran, window: Window) -> bool:
    """The task ran within its window: it runs at the instant t, and at no instant u outside the window; if it did not
    run, it is not needed. THERE IS a t such that FOR ALL u.
    """
    if not ran.some:
        return not needed
    at_u = runs_at(u, ran.start, ran.end)
    return runs_at(t, ran.start, ran.end) and (not at_u or inside(u, window))


# ---- operators --------------------------------------------------------------------------------


def allowed_with(t: int, op: int, first: bool, so_far: bool, before: Part, part: Part) -> bool:
    """With one more operand, the term was done as it permits, as seen at the instant t. FOR ALL t.

    `+`: one of the operands fits and was done as it permits. Otherwise each operand was done as it permits, and the
    operand before it let it begin. first: there is no operand before; so_far: the result for the operands before.
    """
    if op == ALTERNATIVE:
        return (so_far and not first) or (part.fits and part.allowed)
    waits = first or lets_begin(t, op, before.whole, before.ran, part.ran)
    return so_far and part.allowed and waits


def whole_with(op: int, first: bool, so_far: bool, part: Part) -> bool:
    """With one more operand, the term is completely done: for `+`, one operand that fits is; otherwise every operand
    is.
    """
    if op == ALTERNATIVE:
        return (so_far and not first) or (part.fits and part.whole)
    return so_far and part.whole
