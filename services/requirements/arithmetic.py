"""Numbers that are calculated from signals, as FRET's requirements have them in comparisons: `+ - * /`, the absolute
value, sines, cosines, roots, and what a number was at the sample before; in definitions also Lustre's `->`, `pre`, `if`.

Such a number is a signal of its own, whose name says how it is made. It is calculated in doubles at each sample, and is
unknown where anything that it is made of is; so are a quotient by zero and the root of a negative number.
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
    """A number that is calculated. text: as FRET writes it, which is its name; unit: of the number; whole: it is an
    integer; kind: of `ONE`, `TWO`, or

    PRE: the first side at the first sample, then what the second was at the sample before; BEFORE: the same, unknown at
    the first sample; BEGINS: the first side at the first sample, then the second; CHOICE: by the first side, a truth
    value (1 or 0), the second or the third; NAMED: its side, which may look at this one at the sample before by its name; QUANTITY: its side, in the unit;
    REACHES, NOT, AND, OR: truth values, for a choice."""

    kind: str
    sides: tuple[Side, ...]
    text: str
    unit: str
    whole: bool


Side = str | float | Term
"""A signal, a number in its unit, or what is calculated."""


def terms(one: Side) -> Iterator[Term]:
    """All terms of a side, sub-terms first, repeated terms included."""
    if isinstance(one, Term):
        for side in one.sides:
            yield from terms(side)
        yield one


class Made(Protocol):
    """A signal, or what may be one."""

    @property
    def made(self) -> Term | None:
        """The term from which the signal is computed; None: it is recorded in the trace."""


def sources(names: Iterable[str], signals: Mapping[str, Made]) -> set[str]:
    """The signals of a trace that these are, or are made of."""
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
    """The calculated signals among some, sample by sample."""

    def __init__(self, names: Iterable[str], signals: Mapping[str, Made]) -> None:
        made = {name: signals[name].made for name in sorted(names)}
        self.made = {name: term for name, term in made.items() if term is not None}
        self._before: dict[str, float | None] = {}
        self._is_first = True

    def row(self, values: Values) -> dict[str, float | None]:
        """The values of a sample, with those that are calculated from them and from the sample before."""
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
    """1 or 0 of truth values; one that decides does so whatever is unknown."""
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
    elif isinstance(side, str):  # what is calculated under a name is looked at by it
        value = done[side] if side in done else values.get(side)
    else:
        value = side
    return value if value is not None and isfinite(value) else None
