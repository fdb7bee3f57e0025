"""The uses of kernels whose results a theorem determines without any condition.

`c.show(c.same(kernel, definition))` holds for every argument that the premises leave; a condition in the goal may
leave fewer, so such goals are analysed further (`decided`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Protocol

import z3

from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.terms import free_names, known, leaves
from cratous.proofs.statements.premise_and_goal import sides

Use = tuple[str, int]
Held = tuple[str, str, str, int]
"""A kernel, a definition, and the use of the kernel that is related to it."""


class Outline(Protocol):
    """The interface needed from a statement read with all functions closed (`relations.Outline`).

    results: for each unknown value that is a kernel's result, or a field of one: the kernel and its uses; meant: for
    each that is a definition's result: the definition; given_to: for each, the arguments; of_folds: uses by `c.fold`.
    Values within arguments do not count.
    """

    obligations: list[Obligation]
    of_folds: set[Use]
    stated_uses: list[tuple[Use, tuple[Any, ...]]]
    results: dict[str, set[tuple[str, Use]]]
    meant: dict[str, str]
    given_to: dict[str, tuple[Any, ...]]

    def rows(self, uses: Iterable[Use]) -> set[str]:
        """The definitions that were evaluated at literals of these uses."""
        ...

    def uses_in(self, term: z3.ExprRef) -> frozenset[Use]:
        """The uses of kernels that a term is made of."""
        ...


def unconditional(claim: Outline, uses: Iterable[Held]) -> frozenset[Held]:
    """The uses whose result, or a field of it, a goal equates with its definition unconditionally.

    Only the plainest forms count: a result equals a term of the definition's results alone, or a number that one was
    evaluated to; or the definition is true of it; or an induction (`_of_induction`).
    """
    wanted = frozenset(uses)
    found = {held for held in wanted if _of_induction(claim, held[2:])}
    for owed in claim.obligations:
        for given, conclusion in sides(owed.goal) if owed.kind == "goal" else ():
            if not given:
                found |= set(_said(claim, conclusion))
    return wanted & found


def _of_induction(claim: Outline, use: Use) -> bool:
    """Whether it is a step's use in an induction whose last part has no condition on items and context.

    The last goal of `c.fold` is an equality that holds under its premises.
    """
    last = [owed.goal for owed in claim.obligations if owed.kind == "use"]
    if use in claim.of_folds or not last:
        return use in claim.of_folds
    others = dict(claim.stated_uses)[use][1:]
    names = set().union(*[_within(claim, goal) for goal in last])
    stepped = any(
        use in claim.uses_in(owed.goal) for owed in claim.obligations if owed.kind == "step"
    )
    return stepped and not any(names & _within(claim, known(leaf)) for leaf in leaves(others))


def _within(claim: Outline, term: z3.ExprRef) -> set[str]:
    """The names in a term, and in the arguments of the uses that it is made of."""
    found: set[str] = set()
    todo = free_names(term)
    while todo:
        name = todo.pop()
        if name in found:
            continue
        found.add(name)
        given = leaves(claim.given_to.get(name, ()))
        todo |= set().union(*[free_names(known(leaf)) for leaf in given])
    return found


def _said(claim: Outline, conclusion: z3.BoolRef) -> Iterator[Held]:
    term = _plain(conclusion)
    yield from _of_definition(claim, term)
    if not z3.is_eq(term):
        yield from _of_row(claim, term)
        return
    for one, other in (map(_plain, term.children()), map(_plain, reversed(term.children()))):
        names = free_names(other)
        if not names:
            yield from _of_row(claim, one)
        meant = {claim.meant.get(name, "") for name in names}
        # if another definition, or an argument, takes part, it may be a condition
        if z3.is_const(one) and len(meant) == 1 and "" not in meant:
            (only,) = meant
            for kernel, use in claim.results.get(str(one), ()):
                # a definition of the kernel's own result may hold for every result
                if use not in claim.uses_in(other):
                    yield kernel, only, *use


def _of_definition(claim: Outline, term: z3.BoolRef) -> Iterator[Held]:
    """A definition that is true, or false, of results passed to it."""
    if z3.is_const(term) and str(term) in claim.meant:
        for name in {str(known(leaf)) for leaf in leaves(claim.given_to[str(term)])}:
            for kernel, use in claim.results.get(name, ()):
                yield kernel, claim.meant[str(term)], *use


def by_way_of(claim: Outline, meant: str) -> frozenset[Use]:
    """Uses for which a goal unconditionally equates another definition's value of the result with this one's.

    Whether that depends on the result at all is determined by runs only.
    """
    found: set[Use] = set()
    for owed in claim.obligations:
        for given, conclusion in sides(owed.goal) if owed.kind == "goal" else ():
            term = _plain(conclusion)
            if given or not z3.is_eq(term):
                continue
            for one, other in (
                map(_plain, term.children()),
                map(_plain, reversed(term.children())),
            ):
                if z3.is_const(other) and claim.meant.get(str(other)) == meant:
                    found |= {held[2:] for held in _of_definition(claim, one)} - claim.uses_in(
                        other
                    )
    return frozenset(found)


def _of_row(claim: Outline, term: z3.ExprRef) -> Iterator[Held]:
    """For a result that is compared with a number: the definitions evaluated for its use."""
    if z3.is_const(term):
        for kernel, use in claim.results.get(str(term), ()):
            yield from ((kernel, meant, *use) for meant in claim.rows([use]))


def _plain(term: z3.ExprRef) -> z3.ExprRef:
    while z3.is_not(term):
        term = term.arg(0)
    return term
