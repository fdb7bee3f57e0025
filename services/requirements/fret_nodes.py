"""The timeless part of FRET's formulas and structured English: Boolean operators, comparisons, and
computed numbers with units. Ambiguous expressions are refused: quotients of integers, most
functions. Operators that occur only in definitions, Lustre's `->`, `pre` and `if`, are in
`fret_streams`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.arithmetic import ABSOLUTE, NEGATED, PRE, QUANTITY, Side, Term
from cratous.services.requirements.formula import MAX_TIME, Join, Not
from cratous.services.requirements.fret_terms import Names, Wrong, number, parsed, value_in
from cratous.services.requirements.units import (
    NONE,
    NoUnit,
    Quantity,
    dimension,
    in_unit,
    product,
    root,
)

if TYPE_CHECKING:
    from lark import Lark

LONGEST = 2000
"""Maximum length of a computed expression, in characters."""
RADIANS = math.pi / 180
"""Radians per degree."""
SIGNS = {"plus": "+", "minus": "-", "times": "*", "over": "/"}
FUNCTIONS = {
    "absReal": 1,
    "absInt": 1,
    "preReal": 2,
    "preInt": 2,
    "preBool": 2,
    "sin": 1,
    "cos": 1,
    "sqrt": 1,
}
"""Supported functions with their number of arguments."""
STREAMS = {"begins": (), "choice": (0,), "before": ()}
"""Nodes of definitions that are numeric or Boolean depending on their context, with the positions
of their parts that are always Boolean.
"""
NOT_SURE = "of a quotient of whole numbers it is not sure whether it is one"
NUMBERS = ("number", "quantity", "given", "negative", *SIGNS)
CALCULATING = ("compare", "negative", *SIGNS)
"""Nodes whose children are numbers or, in a comparison, truth values."""
PLAIN = {"truth": "name", "constant": "word"}


def settled(tree: Any, is_number: bool = False) -> None:
    """Mark each name and constant in the tree as numeric or Boolean; Wrong where the other kind is needed."""
    todo = [(tree, is_number)]
    while todo:
        node, wanted = todo.pop()
        kind = str(node.data)
        for n, child in enumerate(node.children):
            if not hasattr(child, "data"):
                continue
            numeric = _is_calculating(node)
            if kind == "start" or kind in STREAMS:
                numeric = wanted and n not in STREAMS.get(kind, ())
            settle(child, numeric, kind)
            todo.append((child, numeric))


def settle(child: Any, numeric: bool, above: str = "") -> None:
    """Mark a child of a node of kind `above` as numeric or Boolean; Wrong where it is of the other kind."""
    if numeric and str(child.data) in PLAIN:
        child.data = PLAIN[str(child.data)]
    kind = str(child.data)
    if kind in STREAMS:
        return
    is_number = kind in NUMBERS or _is_calculating(child, "compare")
    if numeric and not is_number and kind not in PLAIN.values():
        raise Wrong("a truth value is calculated with", child.meta.start_pos, "a number")
    if not numeric and is_number and above not in ("between", "up_to", "duration"):
        raise Wrong("a number stands for a truth value", child.meta.start_pos, "a comparison")


def _is_calculating(node: Any, but: str = "") -> bool:
    """Whether the children of a node are numbers; nodes of kind `but` do not count."""
    kind = str(node.data)
    if kind == "call":
        return str(node.children[0]) != "preBool"
    return kind in CALCULATING and kind != but


def tree_of(parser: Lark, text: str, language: str, is_number: bool = False) -> Any:
    """The tree of a text, with names and constants marked as numeric where needed; Wrong for a
    syntax error.

    is_number: the whole text is a number.
    """
    tree = parsed(parser, text, language)
    settled(tree, is_number)
    return tree


def term(kind: str, got: list[Any], names: Names, at: int) -> Any:
    """The value of a timeless node at offset `at`, from those of its children; None for a temporal kind."""
    if kind in JOINED:
        return JOINED[kind](*got)
    if kind == "truth":
        return names.truth(got[0])
    if kind == "constant":
        return formulas.TRUE if got[0].lower() == "true" else formulas.FALSE
    if kind == "name":
        return names.of(got[0])
    if kind == "word":
        return bool(got[0].lower() == "true")
    if kind == "number":
        return number(got[0], got[0].start_pos)
    if kind == "compare":
        return names.compared(*got)
    return _Numbers(names, at).made(kind, got)


JOINED: dict[str, Callable[..., formulas.Formula]] = {
    "negation": formulas.Not,
    "both": lambda a, b: formulas.Join(a, b, True),
    "either": lambda a, b: formulas.Join(a, b, False),
    "differ": lambda a, b: formulas.Not(formulas.iff(a, b)),
    "implies": formulas.implies,
    "iff": formulas.iff,
    "if_then": lambda _, a, b: formulas.implies(a, b),
}


class _Numbers:
    """Builds computed numbers at an offset of the text."""

    def __init__(self, names: Names, at: int) -> None:
        self.names, self.at = names, at

    def made(self, kind: str, got: list[Any]) -> Any:
        """The value of an arithmetic node: a quantity if no signal occurs in it, else a term. None
        if the node is of no numeric kind.
        """
        if kind == "call":
            return self._called(got[0], got[1:])
        if kind == "negative":
            (one,) = got
            if isinstance(one, Quantity):
                return Quantity(-one.value, one.unit, f"-{one.text}")
            return self._one(NEGATED, one, "(- {})")
        return self._two(SIGNS[kind], *got) if kind in SIGNS else None

    def _called(self, function: Any, given: list[Any]) -> Any:
        name = str(function)
        if len(given) != FUNCTIONS[name]:
            raise self._wrong("of so many arguments", str(FUNCTIONS[name]), str(len(given)))
        if name.startswith("abs"):
            (one,) = given
            if isinstance(one, Quantity):
                return Quantity(abs(one.value), one.unit, one.text.lstrip("-"))
            return self._one(ABSOLUTE, one, f"{name}({{}})")
        if len(given) == 1:
            return self._real(name, given[0])
        if not self.names.counted:
            raise self._wrong("samples have times, so none is the one before", "", name)
        first, one = given
        if name == "preBool":
            return self._before(first, one)
        if isinstance(one, Quantity):
            raise self._wrong("this never changes", "a signal", one.text)
        text, unit, whole = self._said(one)
        begins, said = self._side(first, unit)
        return self._term(PRE, (begins, one), f"{name}({said},{text})", unit, whole)

    def _real(self, name: str, one: Any) -> Term:
        """A sine or cosine of a dimensionless number or radians, or a root of even powers of units."""
        said, unit = (
            (repr(float(one.value)), one.unit) if isinstance(one, Quantity) else self._said(one)[:2]
        )
        side = float(one.value) if isinstance(one, Quantity) else one
        if name == "sqrt":
            try:
                return self._term(name, (side,), f"{name}({said})", root(unit), False)
            except NoUnit as no:
                raise self._wrong(str(no), "even powers of units, as m^2", unit) from None
        if unit == "deg" and self.names.real:
            said, unit = f"({said} * {RADIANS!r})", "rad"
            side = self._term("*", (side, RADIANS), said, unit, False)
        if unit not in NONE and unit != "rad":
            raise self._wrong(
                "units that do not fit",
                "an angle in rad or deg" if self.names.real else "an angle in rad",
                unit,
            )
        return self._term(name, (side,), f"{name}({said})", unit and "1", False)

    def _before(self, first: Any, phi: Any) -> formulas.Formula:
        """Phi at the previous sample; at the first sample the constant `first`."""
        if first == formulas.FALSE:
            return formulas.once(phi, 1, 1)
        if first == formulas.TRUE:
            return formulas.historically(phi, 1, 1)
        begun = Join(Not(formulas.once(formulas.TRUE, 1, MAX_TIME)), first, True)
        return Join(begun, formulas.once(phi, 1, 1), False)

    def _one(self, kind: str, side: Any, form: str) -> Term:
        text, unit, whole = self._said(side)
        return self._term(kind, (side,), form.format(text), unit, whole)

    def _two(self, sign: str, left: Any, right: Any) -> Any:
        sides = (left, right)
        if isinstance(left, Quantity) and isinstance(right, Quantity):
            return self._folded(sign, left, right)
        unit = self._unit(sign, left, right)
        # in a sum a number takes the unit of the other side; a factor has its own
        (one, said), (other, also) = (self._side(s, unit if sign in "+-" else None) for s in sides)
        whole = all(self._is_whole(side) for side in sides)
        if whole and sign == "/":
            raise self._wrong(NOT_SURE, "a number with a point", sign)
        return self._term(sign, (one, other), f"({said} {sign} {also})", unit, whole)

    def _unit(self, sign: str, left: Any, right: Any) -> str:
        """The unit of the result of an operation on two sides."""
        one, other = (
            side.unit if isinstance(side, Quantity) else self._said(side)[1]
            for side in (left, right)
        )
        if sign in "+-":
            if isinstance(left, Quantity) or isinstance(right, Quantity):
                return other if isinstance(left, Quantity) else one
            if one == other:
                return one
            what = "signals of two units"
            if one and other and dimension(one) != dimension(other):
                what, one = "units that do not fit", f"{dimension(one)}, as {one}"
            raise self._wrong(what, one or "no unit", other or "no unit")
        try:
            return product(one, other, sign)
        except NoUnit as no:
            raise self._wrong(str(no), "units with a product", f"{one} {sign} {other}") from None

    def _is_whole(self, side: Any) -> bool:
        if isinstance(side, Quantity):
            return side.value.denominator == 1 and not {".", "e", "E"} & set(side.text)
        return self._said(side)[2]

    def _said(self, side: Any) -> tuple[str, str, bool]:
        """(text, unit, whether it is an integer) of a signal or a term."""
        if isinstance(side, Term):
            return side.text, side.unit, side.whole
        if not isinstance(side, str) or self.names.signals[side].kind == "bool":
            raise self._wrong("a truth value is calculated with", "a number", str(side))
        return side, self.names.signals[side].unit, self.names.signals[side].kind == "int"

    def _side(self, side: Any, unit: str | None) -> tuple[Side, str]:
        """(A side, its text) for use with `unit`; None: with any, so that a number keeps its own."""
        if isinstance(side, Quantity):
            value = value_in(side, side.unit if unit is None else unit, self.at)
            if unit is None and side.unit not in NONE:
                text = f"{value!r} {side.unit}"
                return Term(QUANTITY, (value,), text, side.unit, False), text
            return value, repr(value)
        text, has, _ = self._said(side)
        if unit is not None and has != unit:
            raise self._wrong("signals of two units", unit or "no unit", has or "no unit")
        return side, text

    def _folded(self, sign: str, left: Quantity, right: Quantity) -> Quantity:
        """The exact result of an operation on two numbers."""
        a, b, unit = left.value, right.value, left.unit
        if sign == "/":
            is_sure = self.names.real or not (self._is_whole(left) and self._is_whole(right))
            if not b or not is_sure:
                raise self._wrong(NOT_SURE, "a number with a point that is not 0", sign)
            value = a / b
        elif sign == "*":
            value = a * b
        else:
            if dimension(unit or "1") != dimension(right.unit or "1"):
                raise self._wrong("units that do not fit", unit or "no unit", right.unit)
            b = in_unit(right, unit) if unit else b
            value = a + b if sign == "+" else a - b
        if sign in "*/":
            try:
                unit = product(left.unit, right.unit, sign)
            except NoUnit as no:
                raise self._wrong(str(no), "units with a product", right.unit) from None
        return Quantity(value, unit, self._short(f"({left.text} {sign} {right.text})"))

    def _term(self, kind: str, sides: tuple[Side, ...], text: str, unit: str, whole: bool) -> Term:
        return Term(kind, sides, self._short(text), unit, whole)

    def _short(self, text: str) -> str:
        """The text, unless it is too long; then Wrong."""
        if len(text) > LONGEST:
            raise self._wrong("what is calculated is too long", f"{LONGEST} characters")
        return text

    def _wrong(self, what: str, expected: str = "", got: str = "") -> Wrong:
        return Wrong(what, self.at, expected, got)
