"""Which uses of kernels a theorem's goals decide at many values, where they have conditions.

First by runs with other results (`other_results`), then by the solver with free ones (`free_results`). What
neither finds within its bounds is not decided, and the use vouches for nothing.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

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
from cratous.proofs.statements.unconditional import Use

Hows = dict[Use, str]
"""How the arguments of uses vary that relate a kernel to its definition (`engine.reachable_paths`)."""
RLIMIT = 100_000
"""The effort of one question."""
QUESTIONS = 24
"""So many questions are put to the solver for a theorem at most."""


def decided(name: str, folder: Path, seed: str, wanted: Iterable[Hows]) -> frozenset[Use]:
    """Of these uses enough for each group, as far as they are found; seed: of all that the theorem rests on."""
    groups = list(wanted)

    def enough(found: set[Use]) -> bool:
        return all(of_more_than_one([group[use] for use in found & group.keys()]) for group in groups)

    claim, whole = outline(name, folder)
    number = {use: n for n, (use, _) in enumerate(claim.stated_uses)}
    uses = sorted(number[use] for use in set().union(*groups) if use in number)
    if not whole or not uses:
        return frozenset()
    names = [use for use, _ in claim.stated_uses]
    rows = frozenset(n for n in uses if claim.rows([names[n]]))
    found: set[int] = set()
    if not claim.asked:  # no run sees the calls of a function
        places = {n: (names[n][0], _places(claim, n)) for n in uses}
        statement = other_results.Statement(load_claim(name, folder)[0], places, rows)
        found = other_results.decided(
            statement, seed, lambda some: enough({names[n] for n in some})
        )
    if not enough({names[n] for n in found}):
        found |= _by_solver(name, folder, [n for n in uses if n not in found], rows)
    return frozenset(names[n] for n in found)


def _places(claim: Outline, number: int) -> dict[Place, z3.ExprRef]:
    terms = map(known, leaves(claim.stated_uses[number][1]))
    return {(number, k): term for k, term in enumerate(terms) if free_names(term)}


def _by_solver(name: str, folder: Path, uses: list[int], rows: frozenset[int]) -> set[int]:
    claim = _freed(load_claim(name, folder)[0], folder)
    possible = _Asking()
    if claim is None:
        return set()
    return {n for n in uses if free_results.decides(claim, n, n in rows, possible)}


def _freed(statement: Callable[[Any], None], folder: Path) -> free_results.FreeResults | None:
    """The claim with free results; None where it cannot be stated so."""
    lemma = functools.cache(lambda other: load_lemma(other, folder))
    claim = free_results.FreeResults(load=lemma)
    try:
        statement(claim)
    except (LiftError, TypeError, ValueError, RuntimeError, AttributeError, KeyError, IndexError):
        return None
    return claim


class _Asking:
    """Asks whether terms can be true together, so many times; then the answer is `unknown`."""

    def __init__(self) -> None:
        self.left = QUESTIONS

    def __call__(self, terms: list[z3.BoolRef]) -> str:
        if self.left == 0:
            return "unknown"
        self.left -= 1
        context = z3.Context()
        asked = [term.translate(context) for term in terms]
        for _, solver, effort in solvers(context, RLIMIT, polynomials=sorts(terms) <= {"Real"}):
            solver.add(*asked)
            said = check(solver, context, effort).result
            if said != "unknown":
                return said
        return "unknown"
