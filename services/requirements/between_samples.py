"""Requirements between samples, for signals with a maximum rate: a comparison that holds at a
sample counts as true only with a margin of the signal's maximum change within half a sampling gap,
otherwise as unknown.

A comparison that is false at a sample is false there, whatever lies between. Where the requirement
needs x >= c to be true, the formula becomes `x >= c and (x >= c + d or unknown)`; where it needs it
to be false, `x >= c or (x >= c - d and unknown)`. Instants near a sample also shift the time
bounds: where it must not hold, `until` has to be false with bounds widened by one gap on either
side; with a lower bound above 0, its left side also has to hold at the sample of its right side, up
to which there is half a gap.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from cratous.services.requirements.arithmetic import ABSOLUTE, NEGATED, QUANTITY, Side, Term
from cratous.services.requirements.formula import (
    MAX_TIME,
    TRUE,
    Always,
    Bounded,
    Formula,
    Join,
    Not,
    Reaches,
    parts,
)
from cratous.services.requirements.specification import Signal

UNKNOWN = Always(1)
SECOND = 10**9


class NoBound(Exception):
    """No bound on the rate of change of a computed number is known; the reason in words."""


def between(formula: Formula, signals: dict[str, Signal], gap_ns: int) -> Formula | None:
    """The formula to check at samples at most gap_ns apart so that the original holds between them
    too; None if none of its signals has a rate. Adds the signals that it needs. Raises NoBound.
    """
    made = _Made(signals, gap_ns)
    needed: dict[int, Formula] = {}
    not_needed: dict[int, Formula] = {}
    """For each part: its form where it must be true, and its form where it must be false."""
    for part in parts(formula):
        mine = id(part)
        if isinstance(part, Reaches):
            needed[mine], not_needed[mine] = made.compared(part)
        elif isinstance(part, Not):
            needed[mine] = _not(part, not_needed[id(part.phi)])
            not_needed[mine] = _not(part, needed[id(part.phi)])
        elif isinstance(part, Always):
            needed[mine] = not_needed[mine] = part
        else:
            sides = id(part.phi), id(part.psi)
            needed[mine] = _of_two(part, *(needed[side] for side in sides))
            not_needed[mine] = _of_two(part, *(not_needed[side] for side in sides))
            if isinstance(part, Bounded):
                needed[mine] = _begun(part, needed[mine])
                not_needed[mine] = _widened(part, not_needed[mine], gap_ns)
    whole = needed[id(formula)]
    return None if whole is formula else whole


def _not(part: Not, phi: Formula) -> Formula:
    return part if phi is part.phi else Not(phi)


def _of_two(part: Join | Bounded, phi: Formula, psi: Formula) -> Formula:
    if phi is part.phi and psi is part.psi:
        return part
    if isinstance(part, Join):
        return Join(phi, psi, part.is_and)
    return Bounded(phi, psi, part.low, part.high, part.past)


def _begun(part: Bounded, found: Formula) -> Formula:
    """With a lower bound above 0: true near the sample only if phi also holds at the sample of psi."""
    if found is part or not isinstance(found, Bounded) or not part.low or found.phi == TRUE:
        return found
    both = replace(found, psi=Join(found.phi, found.psi, True))
    return Join(found, Join(both, UNKNOWN, False), True)


def _widened(part: Bounded, found: Formula, gap_ns: int) -> Formula:
    """Widen the time bounds: an instant within half a gap of the sample reaches samples up to a gap beyond them."""
    if found is part or not isinstance(found, Bounded):
        return found
    low, high = max(0, part.low - gap_ns), min(MAX_TIME, part.high + gap_ns)
    wider = replace(found, low=low, high=high)
    return Join(found, Join(wider, UNKNOWN, True), False)


class _Made:
    """Rewrites comparisons with a margin."""

    def __init__(self, signals: dict[str, Signal], gap_ns: int) -> None:
        self.signals, self.half_ns = signals, Fraction(gap_ns, 2)

    def compared(self, one: Reaches) -> tuple[Formula, Formula]:
        """A comparison where it must be true, and where it must be false."""
        spare = _change(one.left, self.signals, self.half_ns)
        spare += _change(one.right, self.signals, self.half_ns)
        if not spare:
            return one, one
        surely = Join(self._shifted(one, spare), UNKNOWN, False)
        surely_not = Join(self._shifted(one, -spare), UNKNOWN, True)
        return Join(one, surely, True), Join(one, surely_not, False)

    def _shifted(self, one: Reaches, by: Fraction) -> Reaches:
        """The comparison with its margin increased by `by`, rounded so that it is not too small."""
        left, right = one.left, one.right
        if not isinstance(right, str):
            return Reaches(left, _rounded(Fraction(right) + by, by))
        if not isinstance(left, str):
            return Reaches(_rounded(Fraction(left) - by, -by), right)
        spare = _rounded(by, by)
        signal = self.signals[left]
        side: Side = left if signal.made is None else signal.made
        term = Term("-", (side, spare), f"({left} - {spare!r})", signal.unit, False)
        self.signals.setdefault(term.text, Signal("float", signal.unit, made=term))
        return Reaches(term.text, right)


def _rounded(value: Fraction, towards: Fraction) -> float:
    """The value rounded to a double, up if `towards` is positive, otherwise down."""
    found = float(value)
    if Fraction(found) == value:
        return found
    return math.nextafter(found, math.inf if towards > 0 else -math.inf)


def _change(side: Side, signals: Mapping[str, Signal], half_ns: Fraction) -> Fraction:
    """Maximum change of a side since the nearest sample, in its unit."""
    if isinstance(side, str):
        signal = signals[side]
        if signal.made is not None:
            return _change(signal.made, signals, half_ns)
        return signal.rate * (half_ns + signal.hold_ns) / SECOND
    if not isinstance(side, Term) or side.kind == QUANTITY:
        return Fraction(0)
    changes = [_change(one, signals, half_ns) for one in side.sides]
    if not any(changes):
        return Fraction(0)
    if side.kind in ("+", "-", NEGATED, ABSOLUTE):
        return sum(changes, Fraction(0))
    if side.kind in ("*", "/") and not changes[-1] and (by := _number(side.sides[-1])):
        return changes[0] * abs(by) if side.kind == "*" else changes[0] / abs(by)
    if side.kind == "*" and not changes[0] and (by := _number(side.sides[0])):
        return changes[1] * abs(by)
    raise NoBound(f"nothing says how fast {side.text[:60]} changes")


def _number(side: Side) -> Fraction:
    """The number that a side is; 0 for a signal."""
    if isinstance(side, Term):
        return _number(side.sides[0]) if side.kind == QUANTITY else Fraction(0)
    return Fraction(0) if isinstance(side, str) else Fraction(side)
