"""Arbitrary real values of a running statement, drawn only when their value is needed.

A theorem may introduce a value by the equation that defines it (`k * (t - begin) == first`), or bound it by another.
A number drawn in advance would seldom satisfy such premises; a value not used so far takes one that does.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any


class Cell:
    """One arbitrary value: the number drawn for it, or determined by an equation."""

    def __init__(self, draw: Callable[[], Fraction]) -> None:
        self._draw, self.found = draw, None

    found: Fraction | None

    def number(self) -> Fraction:
        if self.found is None:
            self.found = self._draw()
        return self.found


def now(value: Any) -> Any:
    """The value with all open values in it drawn."""
    if isinstance(value, Late):
        return value.number()
    if isinstance(value, Open):
        return bool(value)
    if isinstance(value, tuple):
        parts = [now(part) for part in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return value


PLAIN = (1, 0)
"""Scale and offset of a value as it was drawn."""


class Late:
    """scale * value + offset of one arbitrary value; any use but addition, scaling and comparison draws its number."""

    __slots__ = ("_cell", "_offset", "_scale")

    def __init__(self, cell: Cell, scale: Any = PLAIN[0], offset: Any = PLAIN[1]) -> None:
        self._cell, self._scale, self._offset = cell, scale, offset

    def number(self) -> Fraction:
        """The number; draws it if it is still open."""
        value = self._cell.number()
        if self._scale is PLAIN[0] and self._offset is PLAIN[1] and type(value) is Fraction:
            return value  # most values are neither scaled nor moved
        return Fraction(self._scale * value + self._offset)

    @property
    def is_open(self) -> bool:
        """Whether an equation may still determine the value."""
        return self._cell.found is None and self._scale != 0

    def be(self, wanted: Any) -> None:
        """Set the underlying value so that this expression equals `wanted`."""
        self._cell.found = Fraction(wanted - self._offset) / self._scale

    def __add__(self, other: Any) -> Any:
        if self._cell.found is not None:
            return self.number() + other
        return Late(self._cell, self._scale, self._offset + now(other))

    def __mul__(self, other: Any) -> Any:
        factor = now(other)  # may refer to the same value
        if self._cell.found is not None:
            return self.number() * factor
        return Late(self._cell, self._scale * factor, self._offset * factor)

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self) -> Any:
        return self * -1

    def __sub__(self, other: Any) -> Any:
        return self + -now(other)

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    def __truediv__(self, other: Any) -> Any:
        return self * (Fraction(1) / now(other))

    def __rtruediv__(self, other: Any) -> Any:
        return other / self.number()

    def __pow__(self, other: Any) -> Any:
        return self.number() ** other

    def __abs__(self) -> Fraction:
        return abs(self.number())

    def __lt__(self, other: Any) -> Any:
        return Comparison(self, operator.lt, other)

    def __le__(self, other: Any) -> Any:
        return Comparison(self, operator.le, other)

    def __gt__(self, other: Any) -> Any:
        return Comparison(self, operator.gt, other)

    def __ge__(self, other: Any) -> Any:
        return Comparison(self, operator.ge, other)

    def __eq__(self, other: Any) -> Any:
        return Comparison(self, operator.eq, other)

    def __ne__(self, other: Any) -> Any:
        return Comparison(self, operator.ne, other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return str(self.number())


class Comparison:
    """A comparison with a late value: evaluated on use, or made true by a premise."""

    def __init__(self, late: Late, relation: Callable[[Any, Any], Any], other: Any) -> None:
        self._late, self._relation, self._other = late, relation, other

    def __bool__(self) -> bool:
        return bool(self._relation(self._late.number(), now(self._other)))

    def made_true(self) -> bool:
        """Whether it holds, choosing a number that makes it true if one is open."""
        ours, other = self._late, self._other
        if isinstance(other, Late) and other.is_open and not ours.is_open:
            ours, other = other, ours
        was_open, bound = ours.is_open, now(other)
        if not self and was_open:
            # mirrored at the bound; on the bound for an equation
            apart = 0 if self._relation is operator.eq else bound - ours.number()
            for number in (bound + apart, bound + 1, bound - 1):
                ours.be(number)
                if self:
                    return True
        return bool(self)


class All:
    """A conjunction of statements."""

    def __init__(self, statements: tuple[Any, ...]) -> None:
        self._statements = statements

    def __bool__(self) -> bool:
        return all(list(map(bool, self._statements)))

    def made_true(self) -> bool:
        """Whether all hold, each in turn made true where possible."""
        return all(list(map(made_true, self._statements)))


Open = Comparison | All
"""A statement whose truth may still be open."""


def made_true(statement: Any) -> bool:
    """Whether a statement holds, made true where possible."""
    return statement.made_true() if isinstance(statement, Open) else bool(statement)
