"""Bounds on rounding errors, accumulated along a kernel's operations on doubles.

Beside a computed value v, which represents the real number r, there is a size p to which the bound refers: |v - r| <=
factor * p + slack. Each rule gives the bound of a result from those of its operands; `proofs/methods/rounding.py`
proves each for every pair of bounds that occurs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

UNIT = Fraction(1, 2**53)
"""Relative error of one operation on doubles, rounded to nearest."""
TINY = Fraction(1, 2**1075)
"""Absolute error of a product that underflows."""
FLOOR = Fraction(1, 2**960)
"""Added to the size of a factor whose own error includes underflow, and to every bound."""
LARGEST = 2.0**1023 * (2 - 2.0**-52)


@dataclass(frozen=True)
class Bound:
    """|v - r| <= factor * p + slack."""

    factor: Fraction
    slack: Fraction

    @property
    def exact(self) -> bool:
        """True iff there is no error at all."""
        return not self.factor and not self.slack


EXACT = Bound(Fraction(0), Fraction(0))


def _up(value: Fraction, bits: int) -> Fraction:
    """The next multiple of 2^-bits: keeps the numbers short."""
    return Fraction(math.ceil(value * 2**bits), 2**bits)


def bound_of_sum(a: Bound, b: Bound, unit: Fraction = UNIT) -> Bound:
    """Of fl(x + y) or fl(x - y), for the size fl(p + q)."""
    factor = max(a.factor, b.factor) * (1 + UNIT) + unit
    return Bound(_up(factor, 120), a.slack + b.slack)


def bound_of_product(a: Bound, b: Bound, unit: Fraction = UNIT) -> Bound:
    """Of fl(x * y), for the size fl(p * q), where neither factor has slack."""
    growth = a.factor + b.factor + a.factor * b.factor
    return Bound(_up(growth * (1 + UNIT) + unit, 120), _up(TINY * (1 + growth), 1080))


def bound_of_choice(a: Bound, b: Bound) -> Bound:
    """Of either of two values (the chosen one, the lesser, the greater)."""
    return Bound(max(a.factor, b.factor), max(a.slack, b.slack))


def bound_without_slack(a: Bound) -> Bound:
    """Of the same value, for the size fl(p + FLOOR)."""
    return Bound(_up(a.factor + a.slack / FLOOR, 120), Fraction(0))


def bound_of_double(a: Bound, times: int) -> Bound:
    """Of the product with a power of two, which is exact, for the size times * p."""
    return Bound(a.factor, a.slack * times)


def threshold(a: Bound) -> tuple[float, float]:
    """(C, H) such that fl(fl(C * p) + H) is at least factor * p + slack."""
    factor = float(_up(a.factor * (1 + 8 * UNIT), 120))
    return math.nextafter(factor, math.inf), float(FLOOR)
