"""Metric temporal logic over time-stamped samples, with three verdicts: 0 false, 1 unknown, 2 true.

A trace is samples at strictly rising integer times; a sample that is not later than the one before is
none of the trace. Bounds are of times, inclusive, 0 <= low <= high. For `phi U[low,high] psi` and `phi
S[low,high] psi` the definitions run over the samples in order; a whole trace is the last state. Source:
pointwise semantics of MTL (Koymans 1990; Alur and Henzinger 1993) in Kleene's strong three-valued logic.
"""

from typing import NamedTuple


def must(verdict: int) -> bool:
    """However what is unknown turns out, it is true."""
    return verdict == 2


def may(verdict: int) -> bool:
    """What is unknown may turn out so that it is true."""
    return verdict != 0


def one_of(verdict: int) -> bool:
    """It is one of the three verdicts."""
    return verdict == 0 or verdict == 1 or verdict == 2


def not_(phi: int, said: int) -> bool:
    """Said is `not phi`: it must hold iff phi cannot, and may hold iff phi need not."""
    return one_of(said) and must(said) == (not may(phi)) and may(said) == (not must(phi))


def and_(phi: int, psi: int, said: int) -> bool:
    """Said is `phi and psi`: it must hold iff both must, and may iff both may."""
    return (
        one_of(said)
        and must(said) == (must(phi) and must(psi))
        and may(said) == (may(phi) and may(psi))
    )


def or_(phi: int, psi: int, said: int) -> bool:
    """Said is `phi or psi`: it must hold iff one of them must, and may iff one of them may."""
    return (
        one_of(said)
        and must(said) == (must(phi) or must(psi))
        and may(said) == (may(phi) or may(psi))
    )


class Meant(NamedTuple):
    """An operator at one sample, after samples of a trace.

    last: time of the last one; hold: the least verdict of phi from that sample on; value: of the operator.
    """

    last: int
    hold: int
    value: int


def until_step(meant: Meant, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Meant:
    """A sample more of `phi U[low,high] psi` at the sample at time `at`.

    The value is the greatest, over the samples from `at` on whose distance to it lies in the bounds, of
    the least of psi there and of phi at every sample from `at` on and before it.
    """
    if time <= meant.last:
        return meant
    if time < at:
        return Meant(time, meant.hold, meant.value)
    inside = low <= time - at and time - at <= high
    here = min(meant.hold, psi) if inside else 0
    return Meant(time, min(meant.hold, phi), max(meant.value, here))


def since_step(meant: Meant, time: int, phi: int, psi: int, at: int, low: int, high: int) -> Meant:
    """A sample more of `phi S[low,high] psi` at the sample at time `at`.

    The value is the greatest, over the samples up to `at` whose distance to it lies in the bounds, of the
    least of psi there and of phi at every sample after it up to `at`. So a sample more bounds what was
    found before by its phi, and is found itself. Samples after `at` do not count.
    """
    if time <= meant.last or time > at:
        return meant
    inside = low <= at - time and at - time <= high
    here = psi if inside else 0
    return Meant(time, meant.hold, max(min(meant.value, phi), here))


def at_least(change: float, value: float, bound: float) -> bool:
    """The signal, changed by so much, is at least the bound. FOR ALL changes: margins speak of them."""
    return value + change >= bound
