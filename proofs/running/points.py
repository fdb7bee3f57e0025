"""Numbers that satisfy the premises of a claim, as the solver finds them: its witnesses.

Queries: any point, one at each bound of a premise, and one for each goal where its condition is true. The effort of
each query is bounded, so that the points are the same on every machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import z3

from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.counterexample import Model
from cratous.proofs.engine.solver_order import check
from cratous.proofs.engine.terms import free_values

RLIMIT = 150_000
BOUNDS, GOALS = 5, 5
"""The most bounds of premises, and conditions of goals, that are queried."""
NOT_STRICT = (z3.Z3_OP_LE, z3.Z3_OP_GE)


def _parts(term: z3.BoolRef) -> Iterator[z3.BoolRef]:
    if z3.is_and(term):
        for part in term.children():
            yield from _parts(part)
    else:
        yield term


def _wanted(claim: Claim) -> Iterator[list[z3.BoolRef]]:
    yield []
    bounds = [
        part.arg(0) == part.arg(1)
        for premise in claim.premises
        for part in _parts(premise)
        if part.decl().kind() in NOT_STRICT
    ]
    yield from ([one] for one in bounds[:BOUNDS])
    goals = [o.goal for o in claim.obligations if o.kind == "goal"]
    conditions = [
        part.arg(0)
        for goal in goals
        for part in _parts(goal)
        if z3.is_app_of(part, z3.Z3_OP_IMPLIES)
    ]
    yield from ([one] for one in conditions[:GOALS])


def witnesses(claim: Claim) -> list[dict[str, Any]]:
    """Values of the claim's variables, point by point, where the solver finds them within its effort."""
    base = [*claim.premises, *claim.roots]
    found: list[dict[str, Any]] = []
    # in one context, since the order of queries is the same in every run
    context = z3.Context()
    same = [term.translate(context) for term in base]
    for extra in _wanted(claim):
        solver = z3.Solver(ctx=context)
        solver.add(*same, *[term.translate(context) for term in extra])
        if check(solver, context, RLIMIT).result != "sat":
            continue
        model = Model(solver.model(), context)
        names = {str(value): value for value in free_values([*base, *extra])}
        point = {
            name: model.number(model._model.eval(value.translate(context), model_completion=True))
            for name, value in names.items()
            if "!" not in name and "#" not in name
        }
        point = {name: value for name, value in point.items() if not isinstance(value, str)}
        if point not in found:
            found.append(point)
    return found
