"""Splits a goal into its conditions and its conclusions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet

import z3

from cratous.proofs.engine.terms import free_names


def sides(goal: z3.BoolRef) -> Iterator[tuple[list[z3.BoolRef], z3.BoolRef]]:
    """(given, conclusion) for each conjunct of a goal."""
    if z3.is_and(goal):
        for part in goal.children():
            yield from sides(part)
    elif z3.is_implies(goal):
        condition, rest = goal.children()
        for given, conclusion in sides(rest):
            yield [condition, *given], conclusion
    else:
        yield [], goal


def signs(
    term: z3.BoolRef,
    names: frozenset[str],
    sign: bool = True,
    *,
    within: Callable[[z3.ExprRef], AbstractSet[str]] = free_names,
) -> set[bool]:
    """How values of these names occur in a condition: positively (True), negated (False).

    within: returns the names in a term.
    """
    if not names & within(term):
        return set()
    if z3.is_not(term):
        return signs(term.children()[0], names, not sign, within=within)
    if z3.is_and(term) or z3.is_or(term):
        parts = term.children()
        return set().union(*[signs(part, names, sign, within=within) for part in parts])
    if z3.is_implies(term):
        first, second = term.children()
        before = signs(first, names, not sign, within=within)
        return before | signs(second, names, sign, within=within)
    return {sign}
