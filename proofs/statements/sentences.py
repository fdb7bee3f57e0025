"""A theorem's statement as a sentence: for any ..., given ..., then ...

It is derived from the outline of the claim (`proofs.statements.relations`), in which kernels and definitions stay
closed, so it names them as the statement uses them; the author's own sentence is not used.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import z3

from cratous.core.kernel import Fold
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.terms import known

CLAUSES_MAX = 12
"""The most premises or goals in one list that are written out; the others are counted."""
CLAUSE_MAX, SENTENCE_MAX = 400, 1500
"""A longer clause or sentence is truncated with a note [characters]."""
UNREAD = (
    "no sentence could be made from its statement, which looks into its functions: read its file"
)
VALUES_MAX, OBLIGATIONS_MAX = 200, 300
"""Limits beyond which a statement is about many functions at once, and would change with each of them."""
MANY = "no sentence could be made from its statement, which is about many functions at once: read its file"
JOINED = {
    z3.Z3_OP_OR: (" or ", 1), z3.Z3_OP_AND: (" and ", 2), z3.Z3_OP_ADD: (" + ", 5),
    z3.Z3_OP_SUB: (" - ", 5), z3.Z3_OP_MUL: (" * ", 6), z3.Z3_OP_DIV: (" / ", 6),
    z3.Z3_OP_EQ: (" = ", 4), z3.Z3_OP_LE: (" <= ", 4), z3.Z3_OP_GE: (" >= ", 4),
    z3.Z3_OP_LT: (" < ", 4), z3.Z3_OP_GT: (" > ", 4), z3.Z3_OP_DISTINCT: (" != ", 4),
    z3.Z3_OP_BAND: (" & ", 5), z3.Z3_OP_BOR: (" | ", 5), z3.Z3_OP_BXOR: (" ^ ", 5),
}  # fmt: skip
"""The symbol of an operation between its operands, and its precedence."""
DENIED = {
    z3.Z3_OP_EQ: " != ", z3.Z3_OP_LE: " > ", z3.Z3_OP_GE: " < ", z3.Z3_OP_LT: " >= ",
    z3.Z3_OP_GT: " <= ", z3.Z3_OP_DISTINCT: " = ",
}  # fmt: skip
TURNED = {
    z3.Z3_OP_EQ: z3.Z3_OP_EQ, z3.Z3_OP_LE: z3.Z3_OP_GE, z3.Z3_OP_GE: z3.Z3_OP_LE,
    z3.Z3_OP_LT: z3.Z3_OP_GT, z3.Z3_OP_GT: z3.Z3_OP_LT,
}  # fmt: skip
"""The comparison with its sides exchanged: a number is written last."""


class Call(NamedTuple):
    """A use of a closed function: the function and its arguments."""

    function: Any
    args: tuple[Any, ...]


class Stated(NamedTuple):
    """A claim's content. kinds: of the arbitrary values, by name; calls: the use behind a value, by the prefix of the
    names of its parts; given: premises at each obligation, by its number; items: parts of an item of each
    induction; relation: the hypothesis before an item."""

    kinds: Mapping[str, str]
    calls: Mapping[str, Call]
    obligations: Sequence[Obligation]
    given: Mapping[int, tuple[z3.BoolRef, ...]]
    fold: Fold[Any] | None
    items: tuple[str, ...]
    relation: z3.BoolRef | None


def sentence(stated: Stated) -> str:
    """The statement in one line; `UNREAD` for one that is nested too deeply or outside of the subset, and `MANY` for
    one about many functions at once."""
    if len(stated.kinds) > VALUES_MAX or len(stated.obligations) > OBLIGATIONS_MAX:
        return MANY
    try:
        return _sentence(stated)
    except (RecursionError, ctypes.ArgumentError, z3.Z3Exception):
        return UNREAD  # ctypes, through which z3 is called, changes the type of the recursion error


def _sentence(stated: Stated) -> str:
    text = _Text(stated.calls)
    parts = [f"for any {_values(stated.kinds)}"]
    said: list[z3.BoolRef] = []
    goals: list[str] = []
    examples = 0

    def close() -> None:
        nonlocal examples
        shown = [*goals, *([_examples(examples)] if examples else [])]
        if shown:
            parts.append(f"then {_listed(shown, '; and ')}")
        goals.clear()
        examples = 0

    for number, owed in enumerate(stated.obligations):
        if owed.kind not in ("goal", "base", "step", "use"):
            continue
        given = stated.given.get(number, ())
        new = [p for p in given if not any(p.eq(old) for old in said)]
        if new and owed.kind in ("goal", "step"):
            said += new
            if conditions := _conditions(new, text):
                close()
                parts.append(f"given {_listed(conditions, ' and ')}")
        if owed.kind == "base":
            close()
            names = ", ".join(stated.items) or "nothing"
            fold = stated.fold.name if stated.fold is not None else "the fold"
            parts.append(f"by induction over the items ({names}) of {fold}")
        if owed.kind == "goal" and z3.is_true(z3.simplify(owed.goal)):
            examples += 1
        else:
            goals.append(_goal(owed, stated.relation, text))
    close()
    return _cut(", ".join(parts), SENTENCE_MAX)


def _examples(count: int) -> str:
    return f"{count} example{'' if count == 1 else 's'} with known values hold{'s' * (count == 1)}"


def _goal(owed: Obligation, relation: z3.BoolRef | None, text: _Text) -> str:
    """A goal; in an induction together with the hypothesis."""
    if owed.kind == "base":
        is_known = z3.is_true(z3.simplify(owed.goal))
        return "the relation holds at the start" + ("" if is_known else f": {text.of(owed.goal)}")
    if relation is None or owed.kind == "goal":
        return text.of(owed.goal)
    when = "after it" if owed.kind == "step" else "at the end"
    head = "before an item " if owed.kind == "step" else ""
    return f"if {head}{text.of(relation, 1)} then {when} {text.of(owed.goal, 1)}"


def _conditions(premises: Sequence[z3.BoolRef], text: _Text) -> list[str]:
    """Premises in words; values with the same two bounds are listed together."""
    found: list[str] = []
    ranges: dict[tuple[str, str], list[str]] = {}
    for premise in premises:
        limits = _limits(premise)
        if limits is None:
            found.append(text.of(premise, 2))
        elif limits[1:] != (-(2**61), 2**61):  # every machine integer has these bounds
            low, high = map(_whole, limits[1:])
            ranges.setdefault((low, high), []).append(text.of(limits[0], 5))
    between = [f"{', '.join(v)} in [{low}, {high}]" for (low, high), v in ranges.items()]
    return [*between, *found]


def _limits(premise: z3.BoolRef) -> tuple[z3.ExprRef, int, int] | None:
    """(value, least, most) of a premise that states just such bounds."""
    if not z3.is_and(premise) or premise.num_args() != 2:
        return None
    low, high = (_bound(side) for side in premise.children())
    if low is None or high is None or not low[0].eq(high[0]) or (low[1], high[1]) != (">=", "<="):
        return None
    return low[0], low[2], high[2]


def _bound(side: z3.ExprRef) -> tuple[z3.ExprRef, str, int] | None:
    """(value, `>=` or `<=`, number) of a comparison with a whole number."""
    if not (z3.is_le(side) or z3.is_ge(side)):
        return None
    one, other, sign = side.arg(0), side.arg(1), "<=" if z3.is_le(side) else ">="
    number = z3.simplify(other)
    if not z3.is_int_value(number):
        number, one, sign = z3.simplify(one), other, "<=" if sign == ">=" else ">="
    return (one, sign, number.as_long()) if z3.is_int_value(number) else None


def _listed(clauses: list[str], between: str) -> str:
    shown = [_cut(clause, CLAUSE_MAX) for clause in clauses[:CLAUSES_MAX]]
    more = len(clauses) - len(shown)
    return between.join(shown) + (f"{between}{more} more" if more else "")


def _cut(text: str, most: int) -> str:
    if len(text) <= most:
        return text
    return f"{text[:most]} ... ({len(text) - most} characters more)"


def _values(kinds: Mapping[str, str]) -> str:
    """The arbitrary values by kind; a vector as one value."""
    found: dict[str, list[str]] = {}
    for name, kind in kinds.items():
        root, _, part = name.rpartition(".")
        if part in ("x", "y") and {f"{root}.x", f"{root}.y"} <= set(kinds):
            if part == "x":
                found.setdefault("vector", []).append(root)
            continue
        found.setdefault(kind, []).append(name)
    words = [f"{k}{'s' if len(names) > 1 else ''} {', '.join(names)}" for k, names in found.items()]
    return "; ".join(words) or "values"


class _Text:
    """Terms as text."""

    def __init__(self, calls: Mapping[str, Call]) -> None:
        self.calls = calls
        self.made: dict[tuple[int, int], str] = {}
        self.kept: list[z3.ExprRef] = []

    def of(self, term: z3.ExprRef, outer: int = 0) -> str:
        """The text of a term; outer: precedence of the surrounding operation."""
        key = (term.get_id(), outer)
        if key not in self.made:
            self.kept.append(term)  # kept alive so that its id is not reused
            self.made[key] = self._of(term, outer)
        return self.made[key]

    def _of(self, term: z3.ExprRef, outer: int) -> str:
        kind, parts = term.decl().kind(), term.children()
        if kind == z3.Z3_OP_UNINTERPRETED and not parts:
            return self.value(str(term))
        if z3.is_int_value(term) or z3.is_bv_value(term):
            return _whole(term.as_long())
        if z3.is_rational_value(term):
            value = term.as_fraction()
            low = "" if value.denominator == 1 else f"/{_whole(value.denominator)}"
            return _whole(value.numerator) + low
        if kind in (z3.Z3_OP_TO_REAL, z3.Z3_OP_TO_INT):
            return self.of(parts[0], outer)
        if kind == z3.Z3_OP_NOT:
            return self.denied(parts[0], outer)
        if kind == z3.Z3_OP_IMPLIES:
            return _within(f"if {self.of(parts[0], 1)} then {self.of(parts[1], 1)}", 1, outer)
        if kind == z3.Z3_OP_ITE:
            return self.chosen(*parts, outer=outer)
        if kind == z3.Z3_OP_EQ and z3.is_bool(parts[0]):
            return self.alike(*parts, outer=outer)
        if kind == z3.Z3_OP_UMINUS:
            return _within(f"-{self.of(parts[0], 7)}", 7, outer)
        if kind in TURNED and _is_number(parts[0]) and not _is_number(parts[1]):
            parts, kind = parts[::-1], TURNED[kind]
        if kind in JOINED and parts:
            between, tight = JOINED[kind]
            return _within(
                between.join(self.of(p, tight + (tight > 3)) for p in parts), tight, outer
            )
        return f"{term.decl().name()}({', '.join(map(self.of, parts))})" if parts else str(term)

    def chosen(self, condition: z3.ExprRef, yes: z3.ExprRef, no: z3.ExprRef, *, outer: int) -> str:
        """A choice of two values; for truth values, as Python's `and` and `or`."""
        said, one, other = (self.of(part, 2) for part in (condition, yes, no))
        if other == said:
            return _within(f"{said} and {one}", 2, outer)
        if one == said:
            return _within(f"{said} or {other}", 1, outer)
        return _within(f"{one} if {said} else {other}", 1, outer)

    def alike(self, one: z3.ExprRef, other: z3.ExprRef, *, outer: int) -> str:
        """Equality of two truth values."""
        for value, rest in ((one, other), (other, one)):
            if z3.is_true(value):
                return self.of(rest, outer)
            if z3.is_false(value):
                return self.denied(rest, outer)
        return _within(f"{self.of(one, 2)} exactly where {self.of(other, 2)}", 1, outer)

    def denied(self, term: z3.ExprRef, outer: int) -> str:
        """The negation of a condition."""
        kind = term.decl().kind()
        if kind in DENIED and term.num_args() == 2 and not z3.is_bool(term.arg(0)):
            return _within(DENIED[kind].join(self.of(p, 5) for p in term.children()), 4, outer)
        return _within(f"not {self.of(term, 4)}", 3, outer)

    def value(self, name: str) -> str:
        """An arbitrary value, or the use of a closed function."""
        head, mark, rest = name.partition("#")
        number, dot, field = rest.partition(".")
        call = self.calls.get(f"{head}{mark}{number}") if mark else None
        if call is None:
            return name
        said = f"{_called(call.function)}({', '.join(map(self.argument, call.args))})"
        return f"{said}{dot}{field}"

    def argument(self, value: Any) -> str:
        """A record by its fields."""
        if isinstance(value, tuple):
            inside = [self.argument(part) for part in value]
            fields: tuple[str, ...] = getattr(value, "_fields", ())
            whole = [t.removesuffix(f".{f}") for t, f in zip(inside, fields, strict=False)]
            if len(set(whole)) == 1 and whole[0] not in inside and len(fields) > 1:
                return whole[0]  # all fields of one record are written as that record
            return f"({', '.join(inside)})"
        return self.of(known(value))


def _is_number(term: z3.ExprRef) -> bool:
    return bool(z3.is_int_value(term) or z3.is_rational_value(term))


def _called(function: Any) -> str:
    """A kernel by its name, a definition with the word spec before it."""
    home = function.step if isinstance(function, Fold) else function
    parts = home.__module__.split(".")
    spec = f"spec.{parts[-1]}." if parts[1:2] == ["spec"] else ""
    return f"{spec}{function.__name__}"


def _whole(number: int) -> str:
    """A number; a large power of two as a power."""
    size = abs(number)
    if size >= 2**20 and size & (size - 1) == 0:
        return f"{'-' if number < 0 else ''}2^{size.bit_length() - 1}"
    return str(number)


def _within(text: str, tight: int, outer: int) -> str:
    return f"({text})" if tight < outer else text
