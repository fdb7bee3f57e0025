"""Numbers that detect whether a calculation on doubles would round.

Where every intermediate result is a double, nothing is rounded, so a calculation on doubles must equal the one on
rationals. Otherwise the two may differ, and they are not compared.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from cratous.proofs.running.copies import rational_root


class Rounded(Exception):
    """An intermediate result is not a double."""


def _value(other: Any) -> Fraction:
    return other.value if isinstance(other, Tracked) else Tracked(Fraction(other)).value


def _arithmetic(operation: Callable[[Any, Any], Any], swapped: bool) -> Callable[..., Any]:
    def method(self: Tracked, other: Any) -> Tracked:
        pair = (_value(other), self.value) if swapped else (self.value, _value(other))
        return Tracked(operation(*pair))

    return method


def _comparison(operation: Callable[[Any, Any], bool]) -> Callable[..., Any]:
    def method(self: Tracked, other: Any) -> bool:
        # CPython compares a double with an integer exactly
        return operation(self.value, other.value if isinstance(other, Tracked) else other)

    return method


class Tracked:
    """A rational number that is a double; arithmetic raises Rounded where the result is not one."""

    __slots__ = ("value",)
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, value: Fraction) -> None:
        try:
            same = Fraction(float(value)) == value
        except OverflowError:
            same = False
        if not same:
            raise Rounded
        self.value = value

    __add__ = _arithmetic(operator.add, False)
    __radd__ = _arithmetic(operator.add, True)
    __sub__ = _arithmetic(operator.sub, False)
    __rsub__ = _arithmetic(operator.sub, True)
    __mul__ = _arithmetic(operator.mul, False)
    __rmul__ = _arithmetic(operator.mul, True)
    __truediv__ = _arithmetic(operator.truediv, False)
    __rtruediv__ = _arithmetic(operator.truediv, True)
    __lt__ = _comparison(operator.lt)
    __le__ = _comparison(operator.le)
    __gt__ = _comparison(operator.gt)
    __ge__ = _comparison(operator.ge)
    __eq__ = _comparison(operator.eq)
    __ne__ = _comparison(operator.ne)

    def __neg__(self) -> Tracked:
        return Tracked(-self.value)

    def __abs__(self) -> Tracked:
        return Tracked(abs(self.value))

    def __bool__(self) -> bool:
        return bool(self.value)


def tracked_root(value: Any) -> Tracked:
    """The root of a number if it is a double; Undecided or Rounded otherwise."""
    return Tracked(rational_root(_value(value)))
