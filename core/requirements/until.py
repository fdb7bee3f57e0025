"""Bounded until, for one sample of a trace: decided as soon as no later sample can change it.

Definition: `spec.requirements.operators.until_step`. Two times summarise the samples so far, and all undecided
samples share them: when phi was last unknown, and when psi was last not false. Times are integers in one unit chosen
by the user.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Times(NamedTuple):
    """Of the samples so far: when phi was last unknown, and when psi was last not false."""

    tainted: int
    candidate: int


@kernel(supports="until_holds")
def until_decided(times: Times, time: int, phi: int, psi: int, at: int, low: int, high: int) -> int:
    """What one more sample decides for the one at `at`: 0 false, 1 unknown for good, 2 true, 3 undecided.

    times: of the samples before it; time: of the new sample, not before `at`; phi, psi: verdicts there; at: of a
    sample that waited until then; low, high: bounds of the until, 0 <= low <= high.
    """
    inside = low <= time - at and time - at <= high
    clean = times.tainted < at
    if inside and psi == 2 and clean:
        return 2
    reached = times.candidate >= at + low or (inside and psi != 0)
    stuck = reached and (not clean or phi == 1)
    if time - at >= high or phi == 0 or stuck:
        if reached:
            return 1
        return 0
    return 3


@kernel(supports="until_holds")
def until_times(times: Times, time: int, phi: int, psi: int) -> Times:
    """The two times after one more sample. time: of it; phi, psi: verdicts there."""
    tainted = times.tainted
    candidate = times.candidate
    if phi == 1:
        tainted = time
    if psi != 0:
        candidate = time
    return Times(tainted, candidate)


class Until(NamedTuple):
    """The state of one sample's until: time of the last sample, the shared times, the verdict or 3.

    reached: whether psi was not false, within the bounds, at a sample so far.
    """

    last: int
    times: Times
    verdict: int
    reached: bool


@kernel(supports="until_holds")
def until_next(so_far: Until, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Until:
    """Add a sample; one that is not later than the last is not part of the trace. Arguments: until_decided."""
    if time <= so_far.last:
        return so_far
    verdict = so_far.verdict
    reached = so_far.reached
    if time >= at and verdict == 3:
        verdict = until_decided(so_far.times, time, phi, psi, at, low, high)
        reached = so_far.times.candidate >= at + low or (
            low <= time - at and time - at <= high and psi != 0
        )
    return Until(time, until_times(so_far.times, time, phi, psi), verdict, reached)


@kernel(supports="until_holds")
def until_result(so_far: Until) -> int:
    """The verdict; if the trace ends before it is decided, the verdict on the trace so far."""
    if so_far.verdict != 3:
        return so_far.verdict
    if so_far.reached:
        return 1
    return 0


until_holds = fold(
    name="until_holds",
    implements="requirements.operators.until_step",
    step=until_next,
    start=Until(-(2**62), Times(-(2**62), -(2**62)), 3, False),
    finish=until_result,
)
