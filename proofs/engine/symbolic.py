"""Symbolic values: what a kernel computes on when it is lifted to a z3 term.

A value wraps a z3 term and behaves like a Python number or boolean in the kernel subset. Wherever Python needs a
decision (`if`, `and`, `or`, `not`, `min`, `max`) the value asks the path being explored for it; `proofs.engine.lift`
replays the kernel for every path.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import z3


class LiftError(Exception):
    """A function that cannot be lifted; the message says which and why."""


RANGE = "integer stays in 64 bits"
"""The side condition of 64-bit integers; definitions, which are never compiled, do not have it."""


@dataclass
class Path:
    """One path through a function: decisions so far, their conditions, side conditions.

    roots: defining facts of the square roots met on the path (see `root`).
    """

    decide: Callable[[Path, z3.BoolRef], bool]
    script: list[bool] = field(default_factory=list)
    taken: list[bool] = field(default_factory=list)
    conditions: list[z3.BoolRef] = field(default_factory=list)
    obligations: list[tuple[str, z3.BoolRef]] = field(default_factory=list)
    roots: list[z3.BoolRef] = field(default_factory=list)

    def require(self, text: str, condition: z3.BoolRef) -> None:
        """Record that `condition` must hold here for the function to be defined."""
        if z3.is_true(z3.simplify(condition)):
            return
        given = z3.And(*self.conditions) if self.conditions else z3.BoolVal(True)
        self.obligations.append((text, z3.Implies(given, condition)))


PATHS: list[Path] = []
"""The paths being explored, innermost last: a lifted call within a lifted call has its own."""

INT64 = 2**63
BITS = 64
EXACT = 2**53
"""Every integer up to this magnitude is a double."""


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

    # operations that Python would answer for the object instead of the value that it stands for
    def __bool__(self) -> bool:
        raise LiftError("a number is taken for a truth value: compare it with 0")

    def __str__(self) -> str:
        raise LiftError("a symbolic value is made into text")

    def __repr__(self) -> str:
        raise LiftError("a symbolic value is made into text")

    def __format__(self, how: str) -> str:
        raise LiftError("a symbolic value is made into text")

    def __index__(self) -> int:
        raise LiftError("a symbolic value is taken for a Python integer")

    def __float__(self) -> float:
        raise LiftError("a symbolic value is taken for a double")


def told(value: Any) -> str:
    """A value as text for a message."""
    return " ".join(str(value.term).split()) if isinstance(value, Sym) else repr(value)


def equality(one: Any, other: Any) -> SymBool:
    """Whether two numbers, masks or truth values of one kind are equal; LiftError for two kinds."""
    left, right = _raw(one), _raw(other)
    if left is None or right is None:
        strange = one if left is None else other
        raise LiftError(f"{told(strange)} is compared, which is no value of the kernel subset")
    if z3.is_bv(left) or z3.is_bv(right):
        mask, value = (one, other) if isinstance(one, SymMask) else (other, one)
        return SymBool(mask._operand(value) == mask.term)
    if z3.is_bool(left) and z3.is_bool(right):
        return SymBool(left == right)
    pair = _pair(one, other)
    if pair is None:
        raise LiftError("a truth value is compared with a number")
    return SymBool(pair[0] == pair[1])


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
        return SymBool(self.term == self._truth(other))

    def __ne__(self, other: object) -> Any:
        return SymBool(z3.Xor(self.term, self._truth(other)))

    def _truth(self, other: object) -> z3.BoolRef:
        raw = _raw(other)
        if raw is None or not z3.is_bool(raw):
            raise LiftError(f"a truth value is compared with {told(other)}, which is none")
        return raw


def _pair(a: Any, b: Any) -> tuple[z3.ExprRef, z3.ExprRef] | None:
    """Both operands as terms of one sort; None where one is not a number of the subset."""
    x, y = _raw(a), _raw(b)
    if x is None or y is None or z3.is_bool(x) or z3.is_bool(y):
        return None
    if z3.is_bv(x) or z3.is_bv(y):
        return None
    if z3.is_int(x) and z3.is_real(y):
        x = as_real(x)
    if z3.is_real(x) and z3.is_int(y):
        y = as_real(y)
    return x, y


def as_real(term: z3.ExprRef) -> z3.ExprRef:
    """An integer literal as a real; only literals may stand beside reals.

    A 64-bit integer variable would be rounded in its conversion to a double, which no proof would account for.
    """
    if not z3.is_int(term):
        return term
    if z3.is_app_of(term, z3.Z3_OP_ITE):
        return z3.If(term.arg(0), as_real(term.arg(1)), as_real(term.arg(2)))
    value = z3.simplify(term)
    if not z3.is_int_value(value):
        raise LiftError(f"the integer {term} is mixed with reals; only literals may be")
    if PATHS and abs(value.as_long()) > EXACT:
        raise LiftError(f"the integer {term} beside reals is no double: at most 2**53 is")
    return z3.RealVal(value.as_long())


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
        if pair is not None:
            return SymBool(relation[name](*pair))
        if name in ("eq", "ne"):
            # Python would otherwise compare identities and answer without an error
            raise LiftError(f"a number is compared with {told(other)}, which is none")
        return NotImplemented

    return method


def _arith(operation: Callable[[Any, Any], z3.ExprRef], swap: bool) -> Callable[[Sym, Any], Any]:
    def method(self: Sym, other: Any) -> Any:
        pair = _pair(other, self) if swap else _pair(self, other)
        return NotImplemented if pair is None else _result(operation(*pair))

    return method


def _result(term: z3.ExprRef) -> Sym:
    if z3.is_int(term) and PATHS:
        PATHS[-1].require(RANGE, z3.And(term >= -INT64, term < INT64))
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
    """An integer; every operation on it has the side condition that the result fits in 64 bits."""

    __slots__ = ()
    __hash__ = None

    def __mod__(self, other: Any) -> Any:
        """Only definitions in `spec` use this; the lint keeps it out of kernels."""
        pair = _pair(self, other)
        if pair is None:
            return NotImplemented
        if PATHS:
            # Python and the solver agree only on remainders by positive numbers
            PATHS[-1].require("the modulus is positive", pair[1] > 0)
        return wrap(pair[0] % pair[1])


class SymMask(Sym):
    """A 64-bit mask: bit operations, shifts and tests for equality; as a number it is 0..2^64-1."""

    __slots__ = ()
    __hash__ = None

    def _with(self, other: Any) -> z3.ExprRef | None:
        if isinstance(other, SymMask):
            return other.term
        if isinstance(other, int) and not isinstance(other, bool):
            if not 0 <= other < 2**BITS:
                raise LiftError(f"{other} is no mask of {BITS} bits")
            return z3.BitVecVal(other, BITS)
        return None

    def __and__(self, other: Any) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(self.term & raw)

    def __or__(self, other: Any) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(self.term | raw)

    def __xor__(self, other: Any) -> Any:
        raw = self._with(other)
        return NotImplemented if raw is None else SymMask(self.term ^ raw)

    __rand__, __ror__, __rxor__ = __and__, __or__, __xor__

    def _shift(self, other: Any) -> z3.ExprRef | None:
        """The shift amount; that it lies in 0..63 is an obligation."""
        raw = self._with(other)
        if raw is not None and PATHS:
            PATHS[-1].require("the shift is by 0 to 63 places", z3.ULT(raw, BITS))
        return raw

    def __rshift__(self, other: Any) -> Any:
        """Only definitions in `spec` shift; the lint keeps it out of kernels."""
        raw = self._shift(other)
        return NotImplemented if raw is None else SymMask(z3.LShR(self.term, raw))

    def __lshift__(self, other: Any) -> Any:
        """As for `>>`; Python's result has no fixed width, so that no bit is lost is an obligation."""
        raw = self._shift(other)
        if raw is None:
            return NotImplemented
        moved = self.term << raw
        if PATHS:
            PATHS[-1].require("no bit is shifted out", z3.LShR(moved, raw) == self.term)
        return SymMask(moved)

    def __eq__(self, other: object) -> Any:
        return SymBool(self.term == self._operand(other))

    def __ne__(self, other: object) -> Any:
        return SymBool(self.term != self._operand(other))

    def _operand(self, other: object) -> z3.ExprRef:
        raw = self._with(other)
        if raw is None:
            raise LiftError(f"a mask is compared with {told(other)}, which is none")
        return raw


def root(value: Any) -> Any:
    """The square root of a real: a value r of which only r >= 0 and r * r == x are known.

    Such an r exists for every x >= 0, and x >= 0 is an obligation. Equal arguments get the same r.
    """
    term = _raw(value)
    if term is None or not (z3.is_real(term) or z3.is_int_value(term)):
        raise LiftError(f"sqrt of {told(value)}, which is no real number")
    term = as_real(term)
    result = z3.Real("sqrt!" + hashlib.sha256(term.sexpr().encode()).hexdigest()[:16])
    if not PATHS:
        raise LiftError("sqrt of a symbolic value outside of a lifted function")
    PATHS[-1].require("no root of a negative number", term >= 0)
    known = z3.And(result >= 0, result * result == term)
    PATHS[-1].roots.append(z3.Implies(term >= 0, known))
    return SymReal(result)
