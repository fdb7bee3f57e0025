"""Metric temporal logic over time-stamped samples, with three verdicts: 0 false, 1 unknown, 2 true.

A trace consists of samples at strictly increasing integer times; a sample that is not later than the one before is
not part of the trace. Time bounds are inclusive, 0 <= low <= high. For `phi U[low,high] psi` and `phi S[low,high]
psi` the definitions run over the samples in order; the value for a whole trace is the last state. Source: pointwise
semantics of MTL (Koymans 1990; Alur and Henzinger 1993) in Kleene's strong three-valued logic.
"""

from typing import NamedTuple


def must(verdict: int) -> bool:
    """True however the unknowns are resolved."""
    return verdict == 2


def may(verdict: int) -> bool:
    """True for some resolution of the unknowns."""
    return verdict != 0


def one_of(verdict: int) -> bool:
    """It is one of the three verdicts."""
    return verdict == 0 or verdict == 1 or verdict == 2


def not_(phi: int, said: int) -> bool:
    """`said` is the verdict of `not phi`: it must hold iff phi cannot, and may hold iff phi need not."""
    return one_of(said) and must(said) == (not may(phi)) and may(said) == (not must(phi))


def and_(phi: int, psi: int, said: int) -> bool:
    """`said` is the verdict of `phi and psi`: it must hold iff both must, and may iff both may."""
    return (
        one_of(said)
        and must(said) == (must(phi) and must(psi))
        and may(said) == (may(phi) and may(psi))
    )


def or_(phi: int, psi: int, said: int) -> bool:
    """`said` is the verdict of `phi or psi`: it must hold iff one of them must, and may iff one of them may."""
    return (
        one_of(said)
        and must(said) == (must(phi) or must(psi))
        and may(said) == (may(phi) or may(psi))
    )


class Meant(NamedTuple):
    """The state of an operator at one sample, after some samples of a trace.

    last: time of the last sample; hold: the least verdict of phi since that sample; value: of the operator.
    """

    last: int
    hold: int
    value: int


def until_step(meant: Meant, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Meant:
    """Add a sample to `phi U[low,high] psi`, evaluated at the sample at time `at`.

    The value is the greatest, over the samples from `at` on whose distance from it lies in the bounds, of the least
    of psi there and of phi at every sample from `at` on and before it.
    """
    if time <= meant.last:
        return meant
    if time < at:
        return Meant(time, meant.hold, meant.value)
    inside = low <= time - at and time - at <= high
    here = min(meant.hold, psi) if inside else 0
    return Meant(time, min(meant.hold, phi), max(meant.value, here))


def since_step(meant: Meant, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Meant:
    """Add a sample to `phi S[low,high] psi`, evaluated at the sample at time `at`.

    The value is the greatest, over the samples up to `at` whose distance from it lies in the bounds, of the least of
    psi there and of phi at every sample after it up to `at`. So each new sample limits the earlier values by its phi,
    and contributes its own. Samples after `at` do not count.
    """
    if time <= meant.last or time > at:
        return meant
    inside = low <= at - time and at - time <= high
    here = psi if inside else 0
    return Meant(time, meant.hold, max(min(meant.value, phi), here))


def at_least(change: float, value: float, bound: float) -> bool:
    """The signal plus the change is at least the bound. FOR ALL changes: used for margins."""
    return value + change >= bound
