"""Whether each premise of a theorem is needed: the theorem without it, and with a weaker one."""

from __future__ import annotations

import dataclasses
from typing import Any

import z3

from cratous.core import ledger as gate
from cratous.proofs.mutation.keys import Keys, Store
from cratous.proofs.mutation.results import PremiseResult
from cratous.proofs.mutation.solver_queries import ask, renew
from cratous.proofs.mutation.statements import state, stated, theorems_from
from cratous.proofs.mutation.terms import budget, premise_text


def judge_premises(name: str, effort: int, keys: Keys, store: Store) -> list[PremiseResult]:
    """The results for each premise of one theorem; effort: the rlimit that the theorem took."""
    gate.load_all(keys.home)
    theorems_from(keys.folder)
    known = keys.premises(name)
    kept = store.get(known)
    if kept is None:
        renew()
        found = _judge(name, effort)
        store.put(known, {"rows": [dataclasses.asdict(row) for row in found]})
        return found
    return [PremiseResult(**row) for row in kept["rows"]]


def _judge(name: str, effort: int) -> list[PremiseResult]:
    claim = stated(name).claim
    most = budget(effort)

    def without(**how: Any) -> str:
        answers = []
        for obligation in state(name, **how).obligations:
            answers.append(ask([*obligation.given, z3.Not(obligation.goal)], most))
            if answers[-1] == "sat":
                return "matters"
        return "unused" if all(a == "unsat" for a in answers) else "undecided"

    found = []
    for number, premise in enumerate(claim.premises):
        weaker = _weaker(premise)
        dropped = without(dropped=frozenset({number}))
        weakened = "-"
        if weaker is not None and dropped != "unused":

            def swap(k: int, term: z3.BoolRef, at: int = number) -> z3.BoolRef:
                other = _weaker(term) if k == at else None
                return term if other is None else other

            weakened = without(weakened=swap)
        found.append(PremiseResult(name, premise_text(premise), dropped, weakened))
    return found


def _weaker(premise: z3.BoolRef) -> z3.BoolRef | None:
    """A weaker premise: `>` becomes `>=`, `>=` allows one less; None for any other."""
    if z3.is_gt(premise):
        return premise.arg(0) >= premise.arg(1)
    if z3.is_lt(premise):
        return premise.arg(0) <= premise.arg(1)
    if z3.is_ge(premise):
        return premise.arg(0) + 1 >= premise.arg(1)
    if z3.is_le(premise):
        return premise.arg(0) <= premise.arg(1) + 1
    return None
