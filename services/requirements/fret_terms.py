"""Common parts of FRET's formulas and structured English: variables, numbers, comparisons, and
parsing.

FRET has no units: a number is in the unit of the signal that it is compared with. `Names` gives the
meaning of FRET's variables; undeclared variables are refused.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.arithmetic import Term
from cratous.services.requirements.specification import Signal
from cratous.services.requirements.units import Quantity, dimension, in_unit
from cratous.spec.files.limits import DIGITS

if TYPE_CHECKING:
    from lark import Lark

NESTED = 200
CALLS = ("^", "mod")
EVER = formulas.MAX_TIME
"""Bound of operators without one: larger than any time between two samples."""
EARLIER = formulas.once(formulas.TRUE, 1, EVER)
"""There is a previous sample."""


class Wrong(Exception):
    """Text that cannot be read, with the reason and the offset."""

    def __init__(self, what: str, offset: int, expected: str = "", got: str = "") -> None:
        self.what, self.offset, self.expected, self.got = what, offset, expected, got[:60]
        super().__init__(what)


@dataclass(frozen=True)
class Unread:
    """A variable whose definition is not read; why: in words."""

    why: str


@dataclass(frozen=True)
class Defined(Unread):
    """A variable defined by a formula, which may be readable; is_bool: the variable is a truth value."""

    text: str
    is_bool: bool


Meaning = str | Quantity | bool | Unread | Term | formulas.Formula
"""Meaning of a variable: a signal of this name, a number with its unit (none: that of the other
side), a constant, or its definition.
"""
TRUTHS = (formulas.Always, formulas.Reaches, formulas.Not, formulas.Join, formulas.Bounded)


@dataclass(frozen=True)
class Names:
    """Signals by name, and the meaning of other variables; an unbound variable is the signal of its name.

    Computed numbers are added as signals. counted: samples are counted, so each has a previous one;
    real: numbers are real, so that quotients of integers are allowed.
    """

    signals: dict[str, Signal]
    bound: Mapping[str, Meaning]
    counted: bool = False
    real: bool = False

    def of(self, token: Any) -> Meaning:
        """The meaning of the declared variable of a token; Wrong if it is undeclared."""
        name = str(token)
        found = self.bound.get(name, name)
        if isinstance(found, Unread):
            raise Wrong(found.why, token.start_pos, got=name)
        if isinstance(found, str) and found not in self.signals:
            declared = {n for n, s in self.signals.items() if s.made is None}
            known = ", ".join(sorted({*declared, *self.bound})[:8]) or "there is none"
            raise Wrong("nothing says which signal this variable is", token.start_pos, known, name)
        return found

    def truth(self, token: Any) -> formulas.Formula:
        """A Boolean variable used as a formula."""
        found = self.of(token)
        if isinstance(found, bool):
            return formulas.TRUE if found else formulas.FALSE
        if isinstance(found, TRUTHS):
            return found
        if isinstance(found, str) and self.signals[found].kind == "bool":
            return formulas.Reaches(found, 1.0)
        raise Wrong("this variable is no truth value", token.start_pos, "a bool", str(token))

    def compared(self, left: Any, relation: Any, right: Any) -> formulas.Formula:
        """A comparison of two sides: equality of truth values, otherwise of numbers."""
        at = relation.start_pos
        truths = [isinstance(s, (bool, *TRUTHS)) or self._kind(s) == "bool" for s in (left, right)]
        if any(truths):
            if not all(truths) or relation not in ("=", "!="):
                raise Wrong("a truth value is compared", at, "= or != with another", str(relation))
            one, other = (_truth(side) for side in (left, right))
            same = formulas.iff(one, other)
            return same if relation == "=" else formulas.Not(same)
        left, right = (self.named(side) for side in (left, right))
        units = [self.signals[side].unit for side in (left, right) if isinstance(side, str)]
        if not units:
            raise Wrong("no signal is compared", at, "a signal on one side")
        self.refuse_units(units, at)
        values = [
            side if isinstance(side, str) else value_in(side, units[0], at)
            for side in (left, right)
        ]
        relation = {"=": "=="}.get(str(relation), str(relation))
        return formulas.compared(values[0], relation, values[1])

    def named(self, side: Any) -> Any:
        """The name of the signal made for a computed side; any other side unchanged."""
        if not isinstance(side, Term):
            return side
        self.signals.setdefault(side.text, Signal("float", side.unit, made=side))
        return side.text

    @staticmethod
    def refuse_units(units: Sequence[str], at: int) -> None:
        """Wrong if two compared signals have different units."""
        if len(set(units)) < 2:
            return
        one, other = units
        if not (one and other) or dimension(one) == dimension(other):
            what = "signals of two units are compared"
            raise Wrong(what, at, one or "no unit", other or "no unit")
        raise Wrong("units that do not fit", at, _expected(one), other)

    def _kind(self, side: Any) -> str:
        return self.signals[side].kind if isinstance(side, str) else ""


def _expected(unit: str) -> str:
    return f"{dimension(unit)}, as {unit}" if unit else "no unit"


def _truth(side: Any) -> formulas.Formula:
    if isinstance(side, TRUTHS):
        return side
    if isinstance(side, str):
        return formulas.Reaches(side, 1.0)
    return formulas.TRUE if side else formulas.FALSE


def value_in(number: Quantity, unit: str, at: int) -> float:
    """The value of a number in a unit; one without unit is already in it. Wrong, with the position,
    if impossible.
    """
    if number.unit and (not unit or dimension(number.unit) != dimension(unit)):
        raise Wrong("units that do not fit", at, _expected(unit), number.unit)
    try:
        return float(in_unit(number, unit) if number.unit else number.value)
    except OverflowError:
        raise Wrong("the number is too large", at, "a double", number.text) from None


def number(text: str, at: int = 0) -> Quantity:
    """A number in FRET's notation; Wrong if it is too long or too large."""
    mantissa, _, exponent = text.lower().partition("e")
    if len(mantissa) > DIGITS or len(exponent) > 4 or abs(int(exponent or "0")) > DIGITS:
        raise Wrong("the number is too long", at, f"up to {DIGITS} digits")
    return Quantity(Fraction(text), "", text)


def parsed(parser: Lark, text: str, language: str) -> Any:
    """The syntax tree of a text; Wrong, with the position, for a syntax error."""
    from lark.exceptions import UnexpectedCharacters, UnexpectedInput

    depth = 0
    for found in re.finditer(r"[()]", text):
        depth += {"(": 1, ")": -1}[found.group()]
        if depth > NESTED:
            raise Wrong("the formula is nested too deeply", found.start(), f"{NESTED} levels")
    try:
        return parser.parse(text)
    except UnexpectedInput as error:
        offset = error.pos_in_stream if error.pos_in_stream is not None else len(text)
        token = None if isinstance(error, UnexpectedCharacters) else getattr(error, "token", None)
        if offset < 0 or (token is not None and token.type == "$END"):
            offset, token = len(text.rstrip()), None
        got = str(token or text[offset : offset + 1]) or "the end of it"
        what = f"this is outside of the part of {language} that is read"
        if got in CALLS:
            what = "this operator of numbers is not read"
        elif got == "(" and (name := re.search(r"[A-Za-z_]\w*\s*$", text[:offset])):
            what = "this function is not read"
            offset, got = name.start(), name.group().strip()
        raise Wrong(what, offset, got=got) from None


def grammar(name: str) -> Lark:
    """The parser of a grammar file in this package."""
    from lark import Lark

    text = Path(__file__).with_name(name).read_text(encoding="utf-8")
    return Lark(text, parser="lalr", propagate_positions=True, maybe_placeholders=False)
