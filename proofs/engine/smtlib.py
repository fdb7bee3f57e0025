"""Obligations as SMT-LIB 2 text, with the smallest logic that holds them.

What is written is the negation of the goal under everything that is given: `unsat` means proved.
"""

from __future__ import annotations

import z3

from cratous.proofs.engine.obligation import Obligation

Seen = dict[int, tuple[z3.ExprRef, set[str]]]
"""Kinds of values in a term by the term's id; the term is kept alive so that its id stays unique."""


def sorts(terms: list[z3.ExprRef], seen: Seen | None = None) -> set[str]:
    """Kinds of values in the terms: Real, Int, BitVec, quantifier, nonlinear, function.

    Obligations of one claim share most of their terms: terms in `seen` are not traversed again.
    """
    if seen is None:
        return _sorts(terms)
    for term in terms:
        if term.get_id() not in seen:
            seen[term.get_id()] = term, _sorts([term])
    return set().union(*[seen[term.get_id()][1] for term in terms])


def _sorts(terms: list[z3.ExprRef]) -> set[str]:
    found: set[str] = set()
    seen: set[int] = set()
    todo = list(terms)
    while todo:
        term = todo.pop()
        if term.get_id() in seen:
            continue
        seen.add(term.get_id())
        if z3.is_quantifier(term):
            found.add("quantifier")
            todo.append(term.body())
            continue
        below = term.children()
        if z3.is_real(term):
            found.add("Real")
        elif z3.is_int(term):
            found.add("Int")
        elif z3.is_bv(term):
            found.add("BitVec")
        if z3.is_app(term):
            kind = term.decl().kind()
            if kind == z3.Z3_OP_UNINTERPRETED and below:
                found.add("function")
            factors = [b for b in below if not _literal(b)]
            if kind == z3.Z3_OP_MUL and len(factors) > 1:
                found.add("nonlinear")
            if kind in (z3.Z3_OP_POWER, z3.Z3_OP_MOD, z3.Z3_OP_IDIV, z3.Z3_OP_REM):
                found.add("nonlinear")
            if kind == z3.Z3_OP_DIV and not _literal(below[1]):
                found.add("nonlinear")
        todo += below
    return found


def _literal(term: z3.ExprRef) -> bool:
    if z3.is_app(term) and term.decl().kind() in (z3.Z3_OP_UMINUS, z3.Z3_OP_TO_REAL):
        return _literal(term.children()[0])
    return bool(z3.is_int_value(term) or z3.is_rational_value(term))


def question(obligation: Obligation) -> list[z3.BoolRef]:
    """The conditions that a solver must find unsatisfiable."""
    return [*obligation.given, z3.Not(obligation.goal)]


def logic_of(obligation: Obligation, seen: Seen | None = None) -> str:
    """The smallest SMT-LIB logic that holds the obligation, e.g. QF_NRA or QF_BV.

    seen: kinds of values found in terms so far, shared by the obligations of one claim.
    """
    found = sorts(question(obligation), seen)
    prefix = "" if "quantifier" in found else "QF_"
    functions = "UF" if "function" in found else ""
    numbers = "".join(letter for name, letter in (("Int", "I"), ("Real", "R")) if name in found)
    if "BitVec" in found:
        # a mask beside numbers has no standard logic of its own
        return f"{prefix}{functions}BV" if not numbers else "ALL"
    if not numbers:
        return f"{prefix}{functions or 'UF'}"
    return f"{prefix}{functions}{'N' if 'nonlinear' in found else 'L'}{numbers}A"


def smt2(obligation: Obligation, title: str, seen: Seen | None = None) -> str:
    """The obligation as SMT-LIB 2 with its exact logic: `unsat` means proved.

    seen: as for `logic_of`.
    """
    solver = z3.Solver()
    solver.add(*question(obligation))
    lines = str(solver.to_smt2()).splitlines()
    body = "\n".join(line for line in lines if not line.startswith((";", "(set-info :status")))
    head = [f"; {title}", f"; {obligation.kind}: {obligation.text}", "; expected: unsat"]
    head += [f"(set-logic {logic_of(obligation, seen)})", "(set-info :status unsat)"]
    return "\n".join([*head, body, ""])
