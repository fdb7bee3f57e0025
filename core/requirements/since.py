"""Bounded since, for one sample of a trace: decided at that sample.

Definition: `spec.requirements.operators.since_step`. Four times summarise the samples so far. Times are integers in
one unit chosen by the user.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Found(NamedTuple):
    """Of the samples that are old enough: when psi was last true, and when last not false."""

    true: int
    candidate: int


class Broken(NamedTuple):
    """Of all samples so far: when phi was last not true, and when last false."""

    tainted: int
    broken: int


@kernel(supports="since_holds")
def is_due(time: int, at: int, low: int) -> bool:
    """True iff a sample is old enough for the since at `at`. low: the lower bound, >= 0."""
    return at - time >= low


@kernel(supports="since_holds")
def since_found(found: Found, time: int, psi: int) -> Found:
    """Add a sample that is old enough. time: of it; psi: the verdict there."""
    if psi == 2:
        return Found(time, time)
    if psi == 1:
        return Found(found.true, time)
    return found


@kernel(supports="since_holds")
def since_broken(broken: Broken, time: int, phi: int) -> Broken:
    """Add a sample. time: of it; phi: the verdict there."""
    if phi == 0:
        return Broken(time, time)
    if phi == 1:
        return Broken(time, broken.broken)
    return broken


@kernel(supports="since_holds")
def since_decided(found: Found, broken: Broken, at: int, high: int) -> int:
    """The verdict at `at`: 0 false, 1 unknown, 2 true.

    found, broken: of the samples up to `at`; high: the upper bound of the since.
    """
    if found.true >= at - high and found.true >= broken.tainted:
        return 2
    if found.candidate >= at - high and found.candidate >= broken.broken:
        return 1
    return 0


class Since(NamedTuple):
    """The state of one sample's since: time of the last sample, the four times, the verdict."""

    last: int
    found: Found
    broken: Broken
    verdict: int


@kernel(supports="since_holds")
def since_next(so_far: Since, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Since:
    """Add a sample; one that is not later than the last, or later than `at`, does not count.

    time: of the sample; phi, psi: verdicts there; at: of the sample whose since it is; low, high: bounds, 0 <= low <=
    high.
    """
    if time <= so_far.last or time > at:
        return so_far
    found = so_far.found
    if is_due(time, at, low):
        found = since_found(so_far.found, time, psi)
    broken = since_broken(so_far.broken, time, phi)
    return Since(time, found, broken, since_decided(found, broken, at, high))


@kernel(supports="since_holds")
def since_result(so_far: Since) -> int:
    """The verdict after the last sample."""
    return so_far.verdict


since_holds = fold(
    name="since_holds",
    implements="requirements.operators.since_step",
    step=since_next,
    start=Since(-(2**62), Found(-(2**62) - 1, -(2**62) - 1), Broken(-(2**62), -(2**62)), 0),
    finish=since_result,
)
