"""Numbers that are calculated from signals, as FRET's requirements have them in comparisons: `+ - * /`, the absolute
value, and what a number was at the sample before.

Such a number is a signal of its own, whose name says how it is made. It is calculated in doubles at each sample, and is
unknown where anything that it is made of is; so is a quotient by zero.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Protocol

Values = Mapping[str, float | None]
PRE, NEGATED, ABSOLUTE = "pre", "negated", "absolute"
TWO: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


@dataclass(frozen=True)
class Term:
    """A number that is calculated. kind: of `TWO`, NEGATED, ABSOLUTE, or PRE, whose sides are what counts at the first
    sample, and what the sample before had; text: as FRET writes it, which is its name; unit: of the number; whole: it
    is an integer."""

    kind: str
    sides: tuple[Side, ...]
    text: str
    unit: str
    whole: bool


Side = str | float | Term
"""A signal, a number in its unit, or what is calculated."""


def terms(one: Side) -> Iterator[Term]:
    """All terms of a side, parts before the whole, each as often as it stands there."""
    if isinstance(one, Term):
        for side in one.sides:
            yield from terms(side)
        yield one


class Made(Protocol):
    """A signal, or what may be one."""

    @property
    def made(self) -> Term | None:
        """Of what it is calculated; None: it stands in the trace."""


def sources(names: Iterable[str], signals: Mapping[str, Made]) -> set[str]:
    """The signals of a trace that these are, or are made of."""
    found: set[str] = set()
    for name in names:
        made = signals[name].made
        inside = [name] if made is None else [s for t in terms(made) for s in t.sides]
        found.update(side for side in inside if isinstance(side, str))
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
                if term.kind == PRE:
                    kept[term.text] = _of(term.sides[1], values, done)
        self._before, self._is_first = kept, False
        found.update({name: done[term.text] for name, term in self.made.items()})
        return found

    def _value(self, term: Term, values: Values, done: Values) -> float | None:
        if term.kind == PRE:
            if self._is_first:
                return _of(term.sides[0], values, done)
            return self._before[term.text]
        sides = [_of(side, values, done) for side in term.sides]
        known = [side for side in sides if side is not None]
        if len(known) < len(sides):
            return None
        try:
            found = _calculated(term.kind, known)
        except (ZeroDivisionError, OverflowError):
            return None
        return found if isfinite(found) else None


def _calculated(kind: str, sides: list[float]) -> float:
    if kind == NEGATED:
        return -sides[0]
    return abs(sides[0]) if kind == ABSOLUTE else TWO[kind](sides[0], sides[1])


def _of(side: Side, values: Values, done: Values) -> float | None:
    value = (
        done[side.text]
        if isinstance(side, Term)
        else values.get(side)
        if isinstance(side, str)
        else side
    )
    return value if value is not None and isfinite(value) else None
