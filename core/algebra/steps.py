"""What a term of the process algebra permits, operator by operator. Integers, milliseconds.

Definitions and codes of operators (0 a task, 1 `.`, 2 `~`, 3 `|`, 4 `+`) and of timings (0 none, 1 absolute, 2
relative): `spec.algebra.operators`. `core.algebra.terms` applies these kernels to a whole term.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Ran(NamedTuple):
    """What ran of a term: whether any task did, the earliest start and the latest end [ms]."""

    some: bool
    start: int
    end: int


class Window(NamedTuple):
    """A time interval, both ends included [ms]; empty if it ends before it begins."""

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


class Operands(NamedTuple):
    """The operands of a term so far. first: there is none yet; before: the last one."""

    first: bool
    allowed: bool
    whole: bool
    before: Part


class Held(NamedTuple):
    """A term. allowed: it was done as it permits; whole: all of it was done."""

    allowed: bool
    whole: bool


@kernel(implements="algebra.operators.stands_in_one_of")
def tasks_with(one: int, other: int) -> int:
    """The union of the tasks of two terms, as bit masks (one bit per task)."""
    return one | other


@kernel(implements="algebra.operators.none_beside")
def operand_fits(whole: int, part: int, begun: int) -> bool:
    """True iff all tasks of the whole term that were begun are in the part; bit masks, one bit per task."""
    return (whole & begun) | part == part


@kernel(implements="algebra.operators.seen_together")
def ran_with(one: Ran, other: Ran) -> Ran:
    """What ran of two terms together."""
    if not one.some:
        return other
    if not other.some:
        return one
    return Ran(True, min(one.start, other.start), max(one.end, other.end))


@kernel(implements="algebra.operators.lets_begin")
def in_order(op: int, before_whole: bool, before: Ran, later: Ran) -> bool:
    """True iff an operand waited for the one before it, as the operator requires.

    op: code of the operator; before_whole: the operand before is done whole; before, later: what ran of each [ms]. An
    operand of which nothing ran waits for nothing.
    """
    if not later.some:
        return True
    if op == 1:
        return before_whole and (not before.some or later.start >= before.end)
    if op == 2:
        return before.some and later.start >= before.start
    return True


@kernel(implements="algebra.operators.may_run")
def window_of(
    outer: Window, op: int, timing: int, first: bool, before: Ran, bounds: Window
) -> Window:
    """The window in which tasks of an operand may run that have no timing constraint within it [ms].

    outer: the same window of the term itself; op, timing, bounds: codes and bounds of the term; first: it is the
    first operand; before: what ran of the operand before it.
    """
    if timing == 0:
        return outer
    if timing == 1 or (op != 1 and op != 2):
        return bounds
    if first:
        return outer
    if not before.some:
        return Window(1, 0)
    if op == 1:
        return Window(before.end + bounds.first, before.end + bounds.last)
    return Window(before.start + bounds.first, before.start + bounds.last)


@kernel(implements="algebra.operators.task_is_held")
def task_held(needed: bool, ran: Ran, window: Window) -> bool:
    """True iff a task ran within its window [ms], or did not run and is not needed."""
    if not ran.some:
        return not needed
    return ran.start <= ran.end and window.first <= ran.start and ran.end <= window.last


@kernel(implements="algebra.operators.allowed_with")
def operand_added(so_far: Operands, part: Part, op: int) -> Operands:
    """Add an operand to the state of a term. op: code of the operator.

    For `+`, one operand that fits is enough; otherwise each has to be done as it permits, in the operator's order.
    """
    if op == 4:
        allowed = (so_far.allowed and not so_far.first) or (part.fits and part.allowed)
        whole = (so_far.whole and not so_far.first) or (part.fits and part.whole)
        return Operands(False, allowed, whole, part)
    waits = so_far.first or in_order(op, so_far.before.whole, so_far.before.ran, part.ran)
    allowed = so_far.allowed and part.allowed and waits
    whole = so_far.whole and part.whole
    return Operands(False, allowed, whole, part)


@kernel(supports="operands_held")
def operands_result(so_far: Operands) -> Held:
    """The state of the term after its last operand."""
    return Held(so_far.allowed, so_far.whole)


NOTHING = Operands(True, True, True, Part(True, True, True, Ran(False, 0, 0)))

operands_held = fold(
    name="operands_held",
    implements="algebra.operators.allowed_with",
    step=operand_added,
    start=NOTHING,
    finish=operands_result,
)
