"""Reads requirements in FRETish, the structured English of FRET: the forms that `fretish` writes,
and others.

Grammar: `fretish.lark`. A response after `whenever` applies at each sample at which the condition
holds; after `when`, `if`, `upon`, `where` and `unless` at each at which it becomes true; without a
condition once, at the first sample. Times are exact; if samples are counted, a tick is one sample.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

from cratous.services.requirements import formula as formulas
from cratous.services.requirements.formula import Bounded, Formula, Join, Not, implies
from cratous.services.requirements.fret_formula import FIRST, became
from cratous.services.requirements.fret_nodes import term, tree_of
from cratous.services.requirements.fret_terms import (
    EVER,
    Names,
    Wrong,
    grammar,
    number,
)

if TYPE_CHECKING:
    from lark import Lark

NS = {"micro": 1000, "milli": 10**6, "s": 10**9, "m": 60 * 10**9, "h": 3600 * 10**9}
"""Nanoseconds per time unit, by the beginning of its name."""


def asked(text: str, names: Names, timed: bool) -> Formula:
    """The per-sample requirement of a sentence; Wrong if it cannot be expressed.

    timed: samples have times [ns]; otherwise they are counted.
    """
    tree = tree_of(_parser(), text, "FRETish")
    for node in tree.iter_subtrees():  # children before parents
        kind = str(node.data)
        if kind == "duration":
            node.made = _duration(timed, *node.children)
        elif kind not in PARTS:
            node.made = term(
                kind,
                [getattr(c, "made", c) for c in node.children],
                names,
                int(node.meta.start_pos),
            )
    return _Sentence(tree, names, timed).asked(tree.children[-1].made)


PARTS = {
    "start", "component", "condition", "timing", "in_mode", "in_state", "within", "lasting", "after", "until", "before",
    "immediately", "next", "finally", "always", "never", "eventually",
}  # fmt: skip


class _Sentence:
    """scope, condition: None if absent; each: the condition applies at each sample; timing: its keyword."""

    def __init__(self, tree: Any, names: Names, timed: bool) -> None:
        self.timed = timed
        self.scope: Formula | None = None
        self.condition: Formula | None = None
        self.each, self.timing = False, "eventually"
        self.given: Any = None
        self.at = int(tree.meta.start_pos)
        for node in tree.children[:-1]:
            kind = str(node.data)
            if kind == "in_mode":
                self.scope = names.truth(node.children[-1])
            elif kind == "in_state":
                self.scope = node.children[0].made
            elif kind == "condition":
                self._condition(*node.children)
            elif kind == "timing":
                (word,) = node.children
                self.timing, self.at = str(word.data), int(word.meta.start_pos)
                self.given = word.children[0].made if word.children else None

    def _condition(self, word: Any, phi: Any, is_true: Any = "true") -> None:
        self.each = word.type == "WHENEVER"
        negated = (word.type == "UNLESS") != (is_true.lower() == "false")
        self.condition = Not(phi.made) if negated else phi.made

    def asked(self, r: Formula) -> Formula:
        """The per-sample requirement, with response r."""
        if self.timing == "never":
            self.timing, r = "always", Not(r)
        if self.scope is not None:
            return implies(self._scoped(self.scope), r)
        if self.timing == "always":
            begun = self.condition
            return r if begun is None else implies(formulas.once(begun, 0, EVER), r)
        if self.timing == "until":
            return implies(self._until(self.given), r)
        if self.timing == "before" and self.condition is None:
            return implies(self.given, formulas.once(r, 1, EVER))
        return implies(self._trigger(), self._by(r))

    def _scoped(self, scope: Formula) -> Formula:
        if self.condition is None and self.timing == "always":
            return scope
        if self.condition is None and self.timing == "immediately":
            return self._became(scope)
        if self.each and self.condition is not None and self.timing == "immediately":
            return Join(scope, self.condition, True)
        what = "within a scope this is not read"
        raise Wrong(what, self.at, "always, never or immediately; immediately after whenever")

    def _trigger(self) -> Formula:
        """The samples at which the response becomes due."""
        if self.condition is None:
            return FIRST
        return self.condition if self.each else self._became(self.condition)

    def _became(self, phi: Formula) -> Formula:
        if self.timed:
            what = "samples have times, so none is the one before, and nothing has become true"
            raise Wrong(what, self.at, "whenever")
        return became(phi)

    def _until(self, stop: Formula) -> Formula:
        """The samples before the stop condition, from a trigger on."""
        none = Not(stop)
        if self.condition is None:
            return formulas.historically(none, 0, EVER)
        return Bounded(none, Join(none, self._trigger(), True), 0, EVER, True)

    def _by(self, r: Formula) -> Formula:
        """The response within its timing, counted from a trigger."""
        if self.timing == "immediately":
            return r
        if self.timing == "within":
            return formulas.eventually(r, 0, self.given)
        if self.timing == "lasting":
            return formulas.globally(r, 0, self.given)
        if self.timing in ("after", "next") and self.timed:
            raise Wrong("samples have times, so none is the next one", self.at, "within or for")
        if self.timing == "next":
            return formulas.eventually(r, 1, 1)
        if self.timing == "after":
            late = formulas.eventually(r, 0, self.given + 1)
            return Join(formulas.globally(Not(r), 0, self.given), late, True)
        if self.timing == "before":
            raise Wrong("after a condition this is not read", self.at, "until", "before")
        what = "nothing says by when, so no sample decides it"
        raise Wrong(what, self.at, "within, for, always, never, until", self.timing)


def _duration(timed: bool, token: Any, unit: Any) -> int:
    name = str(unit).lower()
    if name.startswith("tick") == timed:
        what = "ticks have no time" if timed else "samples are counted, so a time has no meaning"
        raise Wrong(what, token.start_pos, "a time" if timed else "ticks", f"{token} {unit}")
    size = next((ns for begin, ns in NS.items() if name.startswith(begin)), 1) if timed else 1
    value = number(str(token), token.start_pos).value * Fraction(size)
    if value.denominator != 1 or not 0 <= value < EVER:
        what = "this time cannot be taken exactly"
        raise Wrong(what, token.start_pos, "a whole number of nanoseconds" if timed else "ticks")
    return int(value)


@cache
def _parser() -> Lark:
    return grammar("fretish.lark")
