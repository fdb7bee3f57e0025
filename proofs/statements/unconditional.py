"""The uses of kernels whose results a theorem determines without any condition.

`c.show(c.same(kernel, definition))` holds for every argument that the premises leave; a condition in the goal may
leave fewer, so such goals are analysed further (`decided`).
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Protocol

import z3

from cratous.core.kernel import qualified
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.terms import free_names, known, leaves
from cratous.proofs.statements.closed_definitions import full_name
from cratous.proofs.statements.premise_and_goal import sides

Use = tuple[str, int]
Held = tuple[str, str, str, int]
"""A kernel, a definition, and the use of the kernel that is related to it."""


class Outline(Protocol):
    """The interface needed from a statement read with all functions closed (`relations.Outline`).

    results: for each unknown value that is a kernel's result, or a field of one: the kernel and its uses; meant: for
    each that is a definition's result: the definition; given_to: for each, the arguments; arguments: of each function, those of all its calls; of_folds: uses by `c.fold`.
    Values within arguments do not count.
    """

    obligations: list[Obligation]
    of_folds: set[Use]
    stated_uses: list[tuple[Use, tuple[Any, ...]]]
    results: dict[str, set[tuple[str, Use]]]
    meant: dict[str, str]
    given_to: dict[str, tuple[Any, ...]]
    arguments: dict[Callable[..., Any], list[tuple[Any, ...]]]

    def rows(self, uses: Iterable[Use], value: z3.ExprRef | None = None) -> set[str]:
        """The definitions that were evaluated at literals of these uses; value: and gave it."""
        ...

    def uses_in(self, term: z3.ExprRef) -> frozenset[Use]:
        """The uses of kernels that a term is made of."""
        ...


def unconditional(claim: Outline, uses: Iterable[Held]) -> frozenset[Held]:
    """The uses whose result, or a field of it, a goal equates with its definition unconditionally.

    Only the plainest forms count: a result equals the definition's own, or is true where all, or some, of them are, of the
    same arguments where both take the same kinds of them; or a number that one was evaluated to; or an induction (`_of_induction`). An equality with a term of
    its results (its negation, twice its value) is no such form: with the definition in the kernel's place it would be
    false. Nor is a definition that is true of the result: it may be true of any.
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

    The last goal of `c.fold` is an equality that holds under its premises; of what the definition gives, not of a term
    that the statement makes of it: its negation, or twice its value.
    """
    last = [owed.goal for owed in claim.obligations if owed.kind == "use"]
    if use in claim.of_folds:
        return all(map(_is_plain_equality, last))
    if not last:
        return False
    others = dict(claim.stated_uses)[use][1:]
    names = set().union(*[_within(claim, goal) for goal in last])
    stepped = any(
        use in claim.uses_in(owed.goal) for owed in claim.obligations if owed.kind == "step"
    )
    return stepped and not any(names & _within(claim, known(leaf)) for leaf in leaves(others))


def _is_plain_equality(goal: z3.BoolRef) -> bool:
    """Whether it is an equality of two values, or several."""
    if z3.is_and(goal):
        return all(map(_is_plain_equality, goal.children()))
    return bool(z3.is_eq(goal) and all(map(z3.is_const, goal.children())))


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
    if not z3.is_eq(term):
        yield from _of_row(claim, term, z3.BoolVal(not z3.is_not(conclusion)))
        return
    for one, other in (term.children(), reversed(term.children())):
        if not free_names(other):
            yield from _of_row(claim, one, other)
        values = _values(other)
        meant = {claim.meant.get(str(value), "") for value in values}
        if z3.is_const(one) and len(meant) == 1 and "" not in meant and not z3.is_not(conclusion):
            (only,) = meant
            for kernel, use in claim.results.get(str(one), ()):
                # a definition of the kernel's own result may hold for every result
                own = use in claim.uses_in(other)
                theirs = [_of_that_field(claim, one, value) for value in values]
                if not own and all(theirs) and all(_of_the_same(claim, use, v) for v in values):
                    yield kernel, only, *use


def _of_that_field(claim: Outline, one: z3.ExprRef, value: z3.ExprRef) -> bool:
    """Whether a definition's value is that of the field of one, by name; true where it has no such field."""
    field = str(one).partition("#")[2].partition(".")[2]
    head, _, rest = str(value).partition("#")
    there = f"{head}#{rest.partition('.')[0]}.{field}"
    return there == str(value) or there not in claim.meant


def _values(term: z3.ExprRef) -> list[z3.ExprRef]:
    """The value that a term is, or of which it says that all, or that some, are true."""
    if z3.is_and(term) or z3.is_or(term):
        return [value for part in term.children() for value in _values(part)]
    return [term]


def of_definition(claim: Outline, meant: str) -> frozenset[Use]:
    """Uses of whose result a goal says, without a condition, that this definition is true of it."""
    found: set[Use] = set()
    for owed in claim.obligations:
        for given, conclusion in sides(owed.goal) if owed.kind == "goal" else ():
            if not given:
                found |= {h[2:] for h in _of_definition(claim, conclusion) if h[1] == meant}
    return frozenset(found)


def _of_the_same(claim: Outline, use: Use, value: z3.ExprRef) -> bool:
    """Whether a definition's value is of the arguments of a use; true where it takes other kinds than the kernel."""
    ours = [known(leaf) for leaf in leaves(dict(claim.stated_uses)[use])]
    theirs = [known(leaf) for leaf in leaves(claim.given_to[str(value)])]
    kinds = [[term.sort() for term in terms] for terms in (ours, theirs)]
    return kinds[0] != kinds[1] or all(a.eq(b) for a, b in zip(ours, theirs, strict=True))


def _of_definition(claim: Outline, term: z3.BoolRef) -> Iterator[Held]:
    """A definition that is true of results passed to it."""
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


def of_further_values(claim: Outline, use: int, meant: str) -> bool:
    """Whether the statement has this definition of some of the use's arguments beside a value that they do not give.

    Then it says that THERE IS such a value, or none: a kernel that is true where there is none denies it. The argument
    of the definition that takes the value is none of the kernel's, by its name.
    """
    own, args = claim.stated_uses[use]
    given = _names_of(claim, args)
    named = {name for f in claim.arguments if qualified(f) == own[0] for name in _parameters(f)}
    for function, calls in claim.arguments.items():
        for call in calls if full_name(function) == meant else ():
            names = {
                p: _names_of(claim, v) for p, v in zip(_parameters(function), call, strict=True)
            }
            further = [p for p, some in names.items() if not some <= given and p not in named]
            ours = [p for p, some in names.items() if some and some <= given]
            if further and ours and own not in claim.uses_in(_all(call)):
                return True
    return False


def names_given(claim: Outline, use: int) -> frozenset[str]:
    """The names in the arguments of a use, and of what these are made of."""
    return frozenset(_names_of(claim, claim.stated_uses[use][1]))


def _parameters(function: Callable[..., Any]) -> list[str]:
    return list(inspect.signature(function).parameters)


def _names_of(claim: Outline, value: Any) -> set[str]:
    return set().union(*[_within(claim, known(leaf)) for leaf in leaves(value)])


def _all(value: Any) -> z3.BoolRef:
    """A term that is made of all parts of a value."""
    return z3.And(*[known(leaf) == known(leaf) for leaf in leaves(value)])


def _of_row(claim: Outline, term: z3.ExprRef, value: z3.ExprRef) -> Iterator[Held]:
    """For a result that equals a number: the definitions that give it where they were evaluated for its use."""
    if z3.is_const(term):
        for kernel, use in claim.results.get(str(term), ()):
            yield from ((kernel, meant, *use) for meant in claim.rows([use], value))


def _plain(term: z3.ExprRef) -> z3.ExprRef:
    while z3.is_not(term):
        term = term.arg(0)
    return term
