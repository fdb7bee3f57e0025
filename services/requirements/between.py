"""What a requirement asks between samples, where a signal has a greatest rate: a comparison that is so at a sample counts as
so only if it is with as much to spare as the signal may change until half way to the next sample, else it is unknown.

A comparison that is not so at a sample is not so there, whatever is between. In a formula this is `x >= c and (x >= c + d
or unknown)` where the requirement needs x >= c to be so, and `x >= c or (x >= c - d and unknown)` where it needs it not to be.
Of an instant near a sample the bounds of time are others too: so `until` has to be false with a gap more on either side where it
must not be so, and where it begins later its left side has to be so with the right one, until which there is half a gap.
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
    """Nothing says how fast what is calculated of these may change; the reason in words."""


def between(formula: Formula, signals: dict[str, Signal], gap_ns: int) -> Formula | None:
    """What is to hold at samples that are gap_ns apart at most, so that the formula holds between them too; None where no
    signal of it has a rate. Signals that it needs are added. Raises NoBound."""
    made = _Made(signals, gap_ns)
    needed: dict[int, Formula] = {}
    not_needed: dict[int, Formula] = {}
    """Of each part, where the requirement needs it to be so, and where it needs it not to be."""
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
    """Where it begins later: it is so of the instants near the sample only if phi is still so with psi."""
    if found is part or not isinstance(found, Bounded) or not part.low or found.phi == TRUE:
        return found
    both = replace(found, psi=Join(found.phi, found.psi, True))
    return Join(found, Join(both, UNKNOWN, False), True)


def _widened(part: Bounded, found: Formula, gap_ns: int) -> Formula:
    """An instant within half a gap of the sample sees what is near samples up to a gap outside of the sample's bounds."""
    if found is part or not isinstance(found, Bounded):
        return found
    low, high = max(0, part.low - gap_ns), min(MAX_TIME, part.high + gap_ns)
    wider = replace(found, low=low, high=high)
    return Join(found, Join(wider, UNKNOWN, True), False)


class _Made:
    """Comparisons with something to spare."""

    def __init__(self, signals: dict[str, Signal], gap_ns: int) -> None:
        self.signals, self.half_ns = signals, Fraction(gap_ns, 2)

    def compared(self, one: Reaches) -> tuple[Formula, Formula]:
        """A comparison where it has to be so, and where it has not."""
        spare = _change(one.left, self.signals, self.half_ns)
        spare += _change(one.right, self.signals, self.half_ns)
        if not spare:
            return one, one
        surely = Join(self._shifted(one, spare), UNKNOWN, False)
        surely_not = Join(self._shifted(one, -spare), UNKNOWN, True)
        return Join(one, surely, True), Join(one, surely_not, False)

    def _shifted(self, one: Reaches, by: Fraction) -> Reaches:
        """Left reaches right and so much more; rounded away from what would be too little."""
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
    """The double that is no nearer to zero change than the number."""
    found = float(value)
    if Fraction(found) == value:
        return found
    return math.nextafter(found, math.inf if towards > 0 else -math.inf)


def _change(side: Side, signals: Mapping[str, Signal], half_ns: Fraction) -> Fraction:
    """By how much a side may have changed from what it was at the nearest sample, in its unit."""
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
    """The number that a side is; 0 of one that is none."""
    if isinstance(side, Term):
        return _number(side.sides[0]) if side.kind == QUANTITY else Fraction(0)
    return Fraction(0) if isinstance(side, str) else Fraction(side)
