"""Symbolic values: what a kernel computes on when it is lifted to a z3 term.

A value wraps a z3 term and behaves like a Python number or boolean in the kernel subset. Wherever
Python needs a decision (`if`, `and`, `or`, `not`, `min`, `max`) the value asks the path that is
being explored which way to go; `proofs.lift` replays the kernel for every way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import z3


@dataclass
class Path:
    """One way through a function: decisions taken so far, their conditions, side conditions."""

    decide: Callable[[Path, z3.BoolRef], bool]
    script: list[bool] = field(default_factory=list)
    taken: list[bool] = field(default_factory=list)
    conditions: list[z3.BoolRef] = field(default_factory=list)
    obligations: list[tuple[str, z3.BoolRef]] = field(default_factory=list)

    def require(self, text: str, condition: z3.BoolRef) -> None:
        """Record that `condition` must hold here for the function to be defined."""
        given = z3.And(*self.conditions) if self.conditions else z3.BoolVal(True)
        self.obligations.append((text, z3.Implies(given, condition)))


PATHS: list[Path] = []
"""The paths being explored, innermost last: a lifted call inside a lifted call has its own."""

INT64 = 2**63


def _raw(value: Any) -> z3.ExprRef | None:
    if isinstance(value, Sym):
        return value.term
    if isinstance(value, bool):
        return z3.BoolVal(value)
    if isinstance(value, int):
        return z3.IntVal(value)
    if isinstance(value, Fraction):
        return z3.RealVal(f"{value.numerator}/{value.denominator}")
    return None


class Sym:
    """Base of symbolic values; `term` is the z3 expression."""

    __slots__ = ("term",)
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, term: z3.ExprRef) -> None:
        self.term = term


def wrap(term: z3.ExprRef) -> Sym:
    """The symbolic value of a z3 term, by its sort."""
    if z3.is_bool(term):
        return SymBool(term)
    if z3.is_bv(term):
        return SymMask(term)
    if z3.is_int(term):
        return SymInt(term)
    return SymReal(term)


class SymBool(Sym):
    """A truth value; asking for it as a Python bool forks the path."""

    __slots__ = ()

    def __bool__(self) -> bool:
        term = z3.simplify(self.term)
        if z3.is_true(term):
            return True
        if z3.is_false(term):
            return False
        if not PATHS:
            raise TypeError("a symbolic truth value was used outside of a lifted function")
        return PATHS[-1].decide(PATHS[-1], self.term)

    def __eq__(self, other: object) -> Any:
        raw = _raw(other)
        return NotImplemented if raw is None else SymBool(self.term == raw)

    def __ne__(self, other: object) -> Any:
        raw = _raw(other)
        return NotImplemented if raw is None else SymBool(z3.Xor(self.term, raw))


def _pair(a: Any, b: Any) -> tuple[z3.ExprRef, z3.ExprRef] | None:
    """Both operands as terms of one sort; None where one is no number of the subset."""
    x, y = _raw(a), _raw(b)
    if x is None or y is None or z3.is_bool(x) or z3.is_bool(y):
        return None
    if z3.is_int(x) and z3.is_real(y):
        # only integer literals may stand beside reals: the lint forbids mixed variables
        x = z3.ToReal(x) if not z3.is_int_value(x) else z3.RealVal(x.as_long())
    if z3.is_real(x) and z3.is_int(y):
        y = z3.ToReal(y) if not z3.is_int_value(y) else z3.RealVal(y.as_long())
    return x, y


def _compare(name: str) -> Callable[[Sym, Any], Any]:
    relation: dict[str, Callable[[Any, Any], z3.BoolRef]] = {
        "lt": lambda x, y: x < y,
        "le": lambda x, y: x <= y,
        "gt": lambda x, y: x > y,
        "ge": lambda x, y: x >= y,
        "eq": lambda x, y: x == y,
        "ne": lambda x, y: x != y,
    }

    def method(self: Sym, other: Any) -> Any:
        pair = _pair(self, other)
        return NotImplemented if pair is None else SymBool(relation[name](*pair))

    return method


def _arith(operation: Callable[[Any, Any], z3.ExprRef], swap: bool) -> Callable[[Sym, Any], Any]:
    def method(self: Sym, other: Any) -> Any:
        pair = _pair(other, self) if swap else _pair(self, other)
        return NotImplemented if pair is None else _result(operation(*pair))

    return method


def _result(term: z3.ExprRef) -> Sym:
    if z3.is_int(term) and PATHS:
        PATHS[-1].require("integer stays in 64 bits", z3.And(term >= -INT64, term < INT64))
    return wrap(term)


class SymNumber(Sym):
    """Arithmetic and comparisons shared by reals and integers."""

    __slots__ = ()
    __hash__ = None

    __lt__ = _compare("lt")
    __le__ = _compare("le")
    __gt__ = _compare("gt")
    __ge__ = _compare("ge")
    __eq__ = _compare("eq")
    __ne__ = _compare("ne")
    __add__ = _arith(lambda x, y: x + y, False)
    __radd__ = _arith(lambda x, y: x + y, True)
    __sub__ = _arith(lambda x, y: x - y, False)
    __rsub__ = _arith(lambda x, y: x - y, True)
    __mul__ = _arith(lambda x, y: x * y, False)
    __rmul__ = _arith(lambda x, y: x * y, True)

    def __neg__(self) -> Any:
        return _result(-self.term)

    def __abs__(self) -> Any:
        return _result(z3.If(self.term >= 0, self.term, -self.term))


class SymReal(SymNumber):
    """A real number."""

    __slots__ = ()
    __hash__ = None

    def __truediv__(self, other: Any) -> Any:
        return _divide(self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _divide(other, self)


def _divide(top: Any, bottom: Any) -> Any:
    pair = _pair(top, bottom)
    if pair is None:
        return NotImplemented
    if PATHS:
        PATHS[-1].require("no division by zero", pair[1] != 0)
    return wrap(pair[0] / pair[1])


class SymInt(SymNumber):
    """An integer; every operation on it carries the obligation to stay in 64 bits."""

    __slots__ = ()
    __hash__ = None

    def __mod__(self, other: Any) -> Any:
        """Only definitions in `spec` use this; the lint keeps it out of kernels."""
        pair = _pair(self, other)
        return NotImplemented if pair is None else wrap(pair[0] % pair[1])


class SymMask(Sym):
    """A 64-bit mask: bit operations and tests for equality."""

    __slots__ = ()
    __hash__ = None

    def _with(self, other: Any) -> z3.ExprRef | None:
        if isinstance(other, SymMask):
            return other.term
        if isinstance(other, int) and not isinstance(other, bool):
            return z3.BitVecVal(other, 64)
        return None

    def __and__(self, other: Any) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(self.term & raw)

    def __or__(self, other: Any) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(self.term | raw)

    def __rshift__(self, other: Any) -> Any:
        """Only definitions in `spec` shift, by a known amount; the lint keeps it out of kernels."""
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(z3.LShR(self.term, raw))

    def __eq__(self, other: object) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymBool(self.term == raw)

    def __ne__(self, other: object) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymBool(self.term != raw)
