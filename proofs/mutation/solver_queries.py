"""Puts many small questions to the solver, in a context separate from that of the terms.

A context is expensive to create, so one serves a whole task: `renew` at its start makes answers and effort
independent of what was asked before and of the process that asks. Effort is bounded by rlimit, never by wall time.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import z3

from cratous.proofs.engine.solver_order import check, solvers

_CONTEXTS: list[z3.Context] = []
_REALS: dict[int, tuple[z3.ExprRef, bool]] = {}
SHARES = (10,)
"""Most of these questions are small: one round over the orders of variables."""


def renew() -> z3.Context:
    """A new context for the following questions."""
    _CONTEXTS[:] = [z3.Context()]
    return _CONTEXTS[0]


def ask(question: Iterable[z3.BoolRef], rlimit: int) -> str:
    """`sat`, `unsat` or `unknown`: whether all these conditions can hold at once.

    Questions in reals only go to the solver for polynomials first, then to the general one; each may spend `rlimit`
    (`solver_order`).
    """
    return values(question, rlimit, [])[0]


def values(
    question: Iterable[z3.BoolRef], rlimit: int, wanted: Iterable[z3.ExprRef]
) -> tuple[str, list[Any] | None]:
    """The answer, and the values of these terms where the conditions hold.

    Numbers are integers or rationals; None unless the answer is `sat` and every value is one of these.
    """
    terms = list(question)
    context = _CONTEXTS[-1] if _CONTEXTS else renew()
    own = [term.translate(context) for term in terms]
    polynomials = all(_reals(term) for term in terms)
    for _, solver, effort in solvers(context, rlimit, polynomials=polynomials, shares=SHARES):
        solver.add(*own)
        answer = check(solver, context, effort).result
        if answer == "sat":
            model = solver.model()
            found = [number(model.eval(t.translate(context), True)) for t in wanted]
            return answer, None if None in found else found
        if answer != "unknown":
            return answer, None
    return "unknown", None


def number(term: z3.ExprRef) -> Any:
    """A constant as a Python number; None for anything else."""
    if z3.is_true(term) or z3.is_false(term):
        return z3.is_true(term)
    if z3.is_int_value(term) or z3.is_bv_value(term):
        return term.as_long()
    if z3.is_rational_value(term):
        return Fraction(term.numerator_as_long(), term.denominator_as_long())
    return None


def _reals(term: z3.ExprRef) -> bool:
    """True iff no integers, masks, functions or quantifiers occur in the term."""
    key = term.get_id()
    if key not in _REALS:
        own = z3.is_int(term) or z3.is_bv(term) or z3.is_quantifier(term)
        own = own or (z3.is_app(term) and term.num_args() > 0 and _function(term))
        # the term is kept alive so that its id stays unique
        _REALS[key] = (term, not own and all(_reals(child) for child in term.children()))
    return _REALS[key][1]


def _function(term: z3.ExprRef) -> bool:
    return bool(term.decl().kind() == z3.Z3_OP_UNINTERPRETED)
