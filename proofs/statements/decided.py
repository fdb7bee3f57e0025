"""Which uses of kernels a theorem's goals decide at many values, where the goals have conditions.

First by runs with other results (`other_results`), then by the solver with free results (`free_results`). A use for
which neither finds this within its bounds is not decided, and vouches for nothing.
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterable
from pathlib import Path

import z3

from cratous.proofs.engine.argument_values import Place
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.reachable_paths import of_more_than_one
from cratous.proofs.engine.smtlib import sorts
from cratous.proofs.engine.solver_order import check, solvers
from cratous.proofs.engine.terms import free_names, known, leaves
from cratous.proofs.engine.theorem_files import load_claim, load_lemma
from cratous.proofs.statements import free_results, other_results
from cratous.proofs.statements.relations import Outline, outline
from cratous.proofs.statements.unconditional import (
    Use,
    by_way_of,
    names_given,
    of_definition,
    of_further_values,
)

Hows = dict[Use, str]
"""For uses that relate a kernel to its definition: how their arguments vary (`engine.reachable_paths`)."""
Group = tuple[str, Hows]
"""A definition, and the uses by which a theorem relates a kernel to it."""
Decided = tuple[str, str, int]
"""A definition, and a use whose result it decides."""
RLIMIT, SHARE = 100_000, 10
"""The effort of one question, and the divisor for the part that a solver for polynomials gets first."""
CALLS = (3_000, 10_000)
"""The most calls of functions for a theorem: before the solver is asked, and after."""
TRIES = 3
"""Further runs at other values: at some seeds in a hundred the values of one run happen to decide too little."""
QUESTIONS = 16
"""The most questions to the solver for a theorem."""


def decided(
    name: str, folder: Path, seed: str | None, wanted: Iterable[Group]
) -> frozenset[Decided]:
    """For each group of uses, enough decided ones to vouch, as far as found; seed: hash of all the theorem depends
    on.

    Empty without a seed.
    """
    if seed is None:
        return frozenset()
    claim, whole = outline(name, folder)
    if not whole:
        return frozenset()
    stated = _Stated(name, folder, claim)
    return frozenset(
        (meant, *use) for meant, hows in wanted for use in stated.decided(meant, hows, seed)
    )


class _Stated:
    """A theorem with its outline."""

    def __init__(self, name: str, folder: Path, claim: Outline) -> None:
        self.folder, self.claim, self.run = folder, claim, load_claim(name, folder)[0]
        self.names = [use for use, _ in claim.stated_uses]
        self.may_run = not claim.asked or _same_premises(
            claim, outline(name, folder, hidden=True)[0]
        )

    @functools.cached_property
    def freed(self) -> free_results.FreeResults | None:
        """The claim with free results; None where it cannot be stated so."""
        lemma = functools.cache(lambda other: load_lemma(other, self.folder))
        claim = free_results.FreeResults(load=lemma)
        try:
            self.run(claim)
        except (
            LiftError,
            TypeError,
            ValueError,
            RuntimeError,
            AttributeError,
            KeyError,
            IndexError,
        ):
            return None
        return claim

    def decided(self, meant: str, hows: Hows, seed: str) -> set[Use]:
        """The uses whose results this definition decides; the search ends once they suffice to vouch."""
        claim = self.claim
        uses = [n for n, use in enumerate(self.names) if use in hows]
        told = by_way_of(claim, meant)
        rows = {n for n in uses if self.names[n] in told or meant in claim.rows([self.names[n]])}
        places = {n: (self.names[n][0], self._places(n)) for n in uses}
        further = {n: names_given(claim, n) for n in uses if of_further_values(claim, n, meant)}
        statement = other_results.Statement(self.run, places, meant, frozenset(rows), further)
        # a definition that is true of a result, without a condition, has only to exclude another
        plain = of_definition(claim, meant)
        found = self._excluding(meant, [n for n in uses if self.names[n] in plain])

        def enough(some: set[int]) -> bool:
            return of_more_than_one([hows[self.names[n]] for n in some])

        # such a use would be found at the few places where another thing is the same as the definition: at x = y
        otherwise, anywhere = set[int](), False
        for calls in CALLS:
            if self.may_run and not enough(found):
                more, anywhere = other_results.decided(statement, seed, calls, enough, otherwise)
                found |= more
            if calls == CALLS[0] and not enough(found):
                left = [n for n in uses if n not in found | otherwise]
                found |= self._by_solver(meant, left, further)
        for again in range(TRIES if self.may_run else 0):
            # where the goals decided a result nowhere, one further run is enough: it stays undecided
            if enough(found) or (again and not anywhere):
                break
            more, some = other_results.decided(
                statement, f"{seed}, {again}", CALLS[-1], enough, otherwise
            )
            found, anywhere = found | more, anywhere or some
        return {self.names[n] for n in found}

    def _places(self, number: int) -> dict[Place, z3.ExprRef]:
        terms = map(known, leaves(self.claim.stated_uses[number][1]))
        return {(number, k): term for k, term in enumerate(terms) if free_names(term)}

    def _excluding(self, meant: str, uses: list[int]) -> set[int]:
        claim, possible = self.freed if uses else None, _Asking()
        if claim is None:
            return set()
        return {n for n in uses if free_results.excludes(claim, n, meant, possible)}

    def _by_solver(self, meant: str, uses: list[int], further: Collection[int]) -> set[int]:
        claim, possible = self.freed, _Asking()
        if claim is None:
            return set()
        found = set()
        for n in uses:
            row = meant in self.claim.rows([self.names[n]])
            if free_results.decides(claim, n, "" if row else meant, possible, further=n in further):
                found.add(n)
        return found


def _same_premises(one: Outline, other: Outline) -> bool:
    """Whether the premises are the same without recorded calls, which a run does not have."""
    both = zip(one.premises, other.premises, strict=False)
    return len(one.premises) == len(other.premises) and all(a.eq(b) for a, b in both)


class _Asking:
    """Decides satisfiability up to QUESTIONS times; then the answer is `unknown`."""

    def __init__(self) -> None:
        self.left = QUESTIONS

    def __call__(self, terms: list[z3.BoolRef]) -> str:
        if self.left == 0:
            return "unknown"
        self.left -= 1
        context = z3.Context()
        asked = [term.translate(context) for term in terms]
        real = sorts(terms) & {"Real", "Int", "BitVec", "quantifier", "function"} == {"Real"}
        first = [next(solvers(context, RLIMIT, polynomials=True, shares=(SHARE,)))] if real else []
        for _, solver, effort in (*first, next(solvers(context, RLIMIT, polynomials=False))):
            solver.add(*asked)
            said = check(solver, context, effort)
            if said.ended:
                self.left = 0  # the effort limit did not bound its time: no further questions
            if said.result != "unknown" or said.ended:
                return said.result
        return "unknown"
