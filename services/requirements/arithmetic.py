"""Computed signals, as in comparisons of FRET requirements: `+ - * /`, absolute value, sines,
cosines, roots, and values at the previous sample; in definitions also Lustre's `->`, `pre`, `if`.

A computed number is a signal of its own, named by its expression. It is computed in doubles at each
sample and is unknown if any operand is unknown; so are quotients by zero and roots of negative
numbers.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Protocol

Values = Mapping[str, float | None]
PRE, NEGATED, ABSOLUTE = "pre", "negated", "absolute"
BEFORE, BEGINS, CHOICE, NAMED, QUANTITY = "before", "begins", "choice", "named", "quantity"
REACHES, NOT, AND, OR = "reaches", "not", "and", "or"
ONE: dict[str, Callable[[float], float]] = {
    NEGATED: operator.neg,
    ABSOLUTE: abs,
    "sin": math.sin,
    "cos": math.cos,
    "sqrt": math.sqrt,
}
TWO: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


@dataclass(frozen=True)
class Term:
    """A computed number. text: its expression in FRET's notation, which is its name; unit: of the
    number; whole: it is an integer; kind: one of `ONE`, `TWO`, or

    PRE: at the first sample the first side, then the previous value of the second; BEFORE: the
    same, but unknown at the first sample; BEGINS: the first side at the first sample, then the
    second; CHOICE: the second or third side, selected by the first, a truth value (1 or 0); NAMED:
    its side, which may refer to this term's previous value by its name; QUANTITY: its side, in the
    unit; REACHES, NOT, AND, OR: truth values, for a choice.
    """

    kind: str
    sides: tuple[Side, ...]
    text: str
    unit: str
    whole: bool


Side = str | float | Term
"""A signal's name, a number in its unit, or a computed number."""


def terms(one: Side) -> Iterator[Term]:
    """All terms of a side, sub-terms first, repeated terms included."""
    if isinstance(one, Term):
        for side in one.sides:
            yield from terms(side)
        yield one


class Made(Protocol):
    """A signal, recorded or computed."""

    @property
    def made(self) -> Term | None:
        """The term from which the signal is computed; None: it is recorded in the trace."""


def sources(names: Iterable[str], signals: Mapping[str, Made]) -> set[str]:
    """The recorded signals among these, and those from which the computed ones are derived."""
    found: set[str] = set()
    for name in names:
        made = signals[name].made
        if made is None:
            found.add(name)
            continue
        parts = list(terms(made))
        inside = {side for term in parts for side in term.sides if isinstance(side, str)}
        found |= inside - {term.text for term in parts if term.kind == NAMED}
    return found


class Calculated:
    """The computed signals among some, evaluated sample by sample."""

    def __init__(self, names: Iterable[str], signals: Mapping[str, Made]) -> None:
        made = {name: signals[name].made for name in sorted(names)}
        self.made = {name: term for name, term in made.items() if term is not None}
        self._before: dict[str, float | None] = {}
        self._is_first = True

    def row(self, values: Values) -> dict[str, float | None]:
        """The values of a sample, extended by those computed from them and from the previous sample."""
        found = dict(values)
        if not self.made:
            return found
        done: dict[str, float | None] = {}
        for one in self.made.values():
            for term in terms(one):
                if term.text not in done:
                    done[term.text] = self._value(term, values, done)
        kept: dict[str, float | None] = {}
        for one in self.made.values():
            for term in terms(one):
                if term.kind in (PRE, BEFORE):
                    kept[term.text] = _of(term.sides[-1], values, done)
        self._before, self._is_first = kept, False
        found.update({name: done[term.text] for name, term in self.made.items()})
        return found

    def _value(self, term: Term, values: Values, done: Values) -> float | None:
        kind = term.kind
        if kind in (PRE, BEFORE, BEGINS):
            if self._is_first:
                return None if kind == BEFORE else _of(term.sides[0], values, done)
            if kind != BEGINS:
                return self._before[term.text]
            return _of(term.sides[1], values, done)
        sides = [_of(side, values, done) for side in term.sides]
        if kind == CHOICE:
            return None if sides[0] is None else sides[1 if sides[0] else 2]
        if kind in (AND, OR):
            return _joined(sides, kind == AND)
        known = [side for side in sides if side is not None]
        if len(known) < len(sides):
            return None
        try:
            found = _calculated(kind, known)
        except (ZeroDivisionError, OverflowError, ValueError):
            return None
        return found if isfinite(found) else None


def _joined(sides: list[float | None], is_and: bool) -> float | None:
    """Conjunction or disjunction of truth values, as 1 or 0; a deciding side decides even if others are unknown."""
    decides = 0.0 if is_and else 1.0
    if decides in sides:
        return decides
    return None if None in sides else 1.0 - decides


def _calculated(kind: str, sides: list[float]) -> float:
    if kind in (NAMED, QUANTITY):
        return sides[0]
    if kind == NOT:
        return 1.0 - sides[0]
    if kind == REACHES:
        return float(sides[0] >= sides[1])
    return ONE[kind](sides[0]) if kind in ONE else TWO[kind](sides[0], sides[1])


def _of(side: Side, values: Values, done: Values) -> float | None:
    if isinstance(side, Term):
        value = done[side.text]
    elif isinstance(side, str):  # a computed number is referred to by its name
        value = done[side] if side in done else values.get(side)
    else:
        value = side
    return value if value is not None and isfinite(value) else None
