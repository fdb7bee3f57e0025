"""Whether messages come in time, a condition has lasted, a start is too early. Integers, milliseconds.

Definitions: `spec.authority.timeliness`. The consequences (a link counts as lost, a threat counts, an offer is made,
a task begins) are up to the services; the timing is decided here.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


@kernel(implements="authority.timeliness.in_time", nonnegative=("bound",))
def in_time(last: int, now: int, bound: int) -> bool:
    """True iff from the last message to now the last was never older than the bound [ms].

    last: when the last message came [ms]; now: the present [ms]; bound: [ms], >= 0.
    """
    return last <= now and now - last <= bound


@kernel(implements="authority.timeliness.lasted", nonnegative=("least",))
def lasted(since: int, now: int, least: int) -> bool:
    """True iff a condition that has been true since then was true during the last `least` milliseconds.

    since: from when on without a break [ms]; now: the present, not before it [ms]; least: how long [ms], >= 0.
    """
    return now - since >= least


@kernel(implements="authority.timeliness.too_early", nonnegative=("margin",))
def too_early(at: int, planned: int, margin: int) -> bool:
    """True iff the planned time is more than the margin ahead of the instant `at` [ms].

    margin: how early is still permitted [ms], >= 0.
    """
    return at + margin < planned


class Beats(NamedTuple):
    """When the last heartbeat came [ms], and whether each so far came in time."""

    last: int
    ok: bool


@kernel(supports="beats_in_time", nonnegative=("bound",))
def beats_step(beats: Beats, time: int, bound: int) -> Beats:
    """Add a heartbeat, or the end of the mission [ms]; bound: the longest gap [ms]."""
    return Beats(time, beats.ok and in_time(beats.last, time, bound))


@kernel(supports="beats_in_time")
def beats_result(beats: Beats) -> bool:
    """Whether each came in time."""
    return beats.ok


beats_in_time = fold(
    name="beats_in_time",
    implements="authority.timeliness.in_time",
    step=beats_step,
    start=Beats(0, True),
    finish=beats_result,
)
