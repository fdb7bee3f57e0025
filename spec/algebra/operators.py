"""What the operators of the process algebra say of their operands, at one instant or of one task.

The meaning of a term (`spec.algebra.meaning`, `spec.algebra.partial`) one operator at a time: of an operand
it is known which tasks stand in it, when what ran of it ran, whether it is done whole, and whether it was
done as it permits. The definitions speak of instants and of single tasks; the kernels
(`core.algebra.steps`) of earliest starts, latest ends and masks. Milliseconds after mission start;
instants are integers, and a definition says how they are quantified.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.schedule import runs_at

TASK, SEQUENTIAL, TILDE, PARALLEL, ALTERNATIVE = 0, 1, 2, 3, 4
"""What a term is: a task, or an operator `.` `~` `|` `+` over operands."""
UNTIMED, ABSOLUTE, RELATIVE = 0, 1, 2
"""The timing of a term: none, `_[t1-t2]`, `-[t1-t2]`."""


class Ran(NamedTuple):
    """What ran of a term: whether anything did, its earliest start and its latest end [ms]."""

    some: bool
    start: int
    end: int


class Seen(NamedTuple):
    """A term at an instant: some task of it has begun; all that ever run of it have ended."""

    begun: bool
    ended: bool


class Window(NamedTuple):
    """A span of time, both ends included [ms]."""

    first: int
    last: int


class Part(NamedTuple):
    """An operand. fits: it has all tasks of the whole term that were begun; allowed: it was done as it
    permits; whole: all of it was done."""

    fits: bool
    allowed: bool
    whole: bool
    ran: Ran


# ---- which tasks ------------------------------------------------------------------------------


def stands_in(k: int, mask: int) -> bool:
    """Task number k is in the set `mask`, of which it is bit k."""
    return (mask >> k) & 1 == 1


def stands_in_one_of(k: int, one: int, other: int) -> bool:
    """Task number k is in one of the two sets. FOR ALL k in 0..63."""
    return stands_in(k, one) or stands_in(k, other)


def none_beside(k: int, whole: int, part: int, begun: int) -> bool:
    """Task number k, if it is in the whole and was begun, is in the part. FOR ALL k in 0..63."""
    return not (stands_in(k, whole) and stands_in(k, begun)) or stands_in(k, part)


# ---- order ------------------------------------------------------------------------------------


def some_begun(t: int, ran: Ran) -> bool:
    """At the instant t some task of a term has begun."""
    return ran.some and ran.start <= t


def all_ended(t: int, ran: Ran) -> bool:
    """At the instant t all that ever ran of a term has ended."""
    return not ran.some or ran.end <= t


def seen(t: int, ran: Ran) -> Seen:
    """A term at the instant t."""
    return Seen(some_begun(t, ran), all_ended(t, ran))


def seen_together(t: int, one: Ran, other: Ran) -> Seen:
    """Two terms at the instant t as one: one has begun if either has, ended have they if both have.
    FOR ALL t."""
    begun = some_begun(t, one) or some_begun(t, other)
    return Seen(begun, all_ended(t, one) and all_ended(t, other))


def lets_begin(t: int, op: int, before_whole: bool, before: Ran, later: Ran) -> bool:
    """What has begun of an operand at the instant t was let begin by the one before it.

    `.`: that is done whole, and all of it has ended; `~`: some of it has begun; under another
    operator nothing waits. FOR ALL t.
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
    """A task that nothing within an operand bounds may run at the instant t. FOR ALL t.

    outer: where the term's own tasks may run if it has no timing; op, timing, bounds: the term's operator
    and timing; first: it is the first operand; before: what ran of the operand before it. A
    relative timing of `.` counts from the instant at which all of the operand before has ended, of `~`
    from that at which some of it has begun, and leaves the first operand to what is outside.
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
    """The task ran as it may: it runs at the instant t, and at no instant u outside of the window; if it
    did not run, it need not. THERE IS a t such that FOR ALL u."""
    if not ran.some:
        return not needed
    at_u = runs_at(u, ran.start, ran.end)
    return runs_at(t, ran.start, ran.end) and (not at_u or inside(u, window))


# ---- operators --------------------------------------------------------------------------------


def allowed_with(t: int, op: int, first: bool, so_far: bool, before: Part, part: Part) -> bool:
    """With one operand more, a term was done as it permits, as far as the instant t shows. FOR ALL t.

    `+`: one of the operands fits and was done as it permits. Else: each was done as it permits, and was let
    begin by the one before it. first: there is none before; so_far: of the operands before.
    """
    if op == ALTERNATIVE:
        return (so_far and not first) or (part.fits and part.allowed)
    waits = first or lets_begin(t, op, before.whole, before.ran, part.ran)
    return so_far and part.allowed and waits


def whole_with(op: int, first: bool, so_far: bool, part: Part) -> bool:
    """With one operand more, a term is done whole: `+`: one operand that fits is; else each is."""
    if op == ALTERNATIVE:
        return (so_far and not first) or (part.fits and part.whole)
    return so_far and part.whole
