"""Inputs and premises of mutated functions as solver terms, and as text."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

import z3

from cratous.proofs.engine.symbolic import SymMask, _raw
from cratous.proofs.engine.terms import free_names, known

GLANCE = 8_000
"""Effort for deciding whether a theorem allows an input."""
NEAR = 120_000
"""Effort for a question whose inputs are fixed."""
FAR = 3_000_000
"""Effort for an open question; a theorem that took more to prove gets twice its own, up to MOST."""
MOST = 10_000_000
SAME = 12_000_000
"""Effort to prove a mutant equivalent: needed rarely, and it saves a manual investigation."""


def budget(effort: int) -> int:
    """The effort allowed for a question about a theorem that took this much to prove."""
    return max(FAR, min(2 * effort, MOST))


def flat(value: Any) -> list[Any]:
    """The scalars of a value, in order."""
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [value]


def is_free(value: Any) -> bool:
    """Whether the value is arbitrary, so that an input determines it directly."""
    term = known(value)
    return bool(z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED)


def equal(args: tuple[Any, ...], row: tuple[Any, ...]) -> list[z3.BoolRef]:
    """Equations of a visit's arguments with these values."""
    equations = []
    for one, value in zip(flat(args), flat(row), strict=True):
        term = _raw(one)
        if isinstance(one, SymMask):
            equations.append(term == z3.BitVecVal(value, 64))
        elif isinstance(value, bool):
            equations.append(term if value else z3.Not(term))
        else:
            if z3.is_int(term) and isinstance(value, Fraction):
                term = z3.ToReal(term)  # a literal of a theorem, where the function takes a real
            equations.append(term == (z3.RealVal(str(value)) if z3.is_real(term) else value))
    return equations


def with_values(
    conditions: list[z3.BoolRef], args: tuple[Any, ...], row: tuple[Any, ...]
) -> bool | None:
    """Whether the conditions can hold where these arguments have these values.

    conditions: jointly satisfiable, so conditions about other values only do not affect the answer. None where the
    solver must decide: arguments are terms, or a condition involves both these and other values.
    """
    if not all(is_free(value) for value in flat(args)):
        return None
    leaves = [known(value) for value in flat(args)]
    if len({leaf.get_id() for leaf in leaves}) < len(leaves):
        return None
    pairs = []
    for leaf, equation in zip(leaves, equal(args, row), strict=True):
        if not z3.is_eq(equation):
            pairs.append((leaf, z3.BoolVal(not z3.is_not(equation))))
        else:
            # the solver prints `x == 2` with the constant first
            first = equation.arg(0).eq(leaf)
            pairs.append((leaf, equation.arg(1) if first else equation.arg(0)))
    names = {str(leaf) for leaf in leaves}
    own = [condition for condition in conditions if free_names(condition) & names]
    found = [z3.simplify(z3.substitute(condition, *pairs)) for condition in own]
    if any(z3.is_false(one) for one in found):
        return False
    return True if all(z3.is_true(one) for one in found) else None


def premise_text(term: z3.ExprRef) -> str:
    """A premise as readable text: in one line, the range of integers in words."""
    text = " ".join(str(term).split())
    ranged = re.fullmatch(rf"And\((\S+) >= -{2**61}, (\S+) <= {2**61}\)", text)
    turned = re.fullmatch(r"(-?\d+) (<=?) (.*)", text)
    if turned:
        return f"{turned[3]} {turned[2].replace('<', '>')} {turned[1]}"
    return f"{ranged[1]} has at most 62 bits" if ranged else text


def row_text(row: tuple[Any, ...]) -> str:
    """An input as text for people."""
    return ", ".join(str(value) for value in flat(row))
