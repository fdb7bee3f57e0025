"""A hash for arguments of opaque functions that does not depend on how a term was built.

The solver sorts operands by internal numbers, which depend on the terms built and freed before. So polynomials are
expanded by its simplifier, and operands of commutative operators are then ordered by their own hashes. Two terms with
one hash are equal; equal terms may have two hashes where the simplifier does not bring them to one form.
"""

from __future__ import annotations

import hashlib

import z3

COMMUTE = frozenset(
    {
        z3.Z3_OP_ADD, z3.Z3_OP_MUL, z3.Z3_OP_AND, z3.Z3_OP_OR, z3.Z3_OP_XOR, z3.Z3_OP_EQ,
        z3.Z3_OP_DISTINCT, z3.Z3_OP_BADD, z3.Z3_OP_BMUL, z3.Z3_OP_BAND, z3.Z3_OP_BOR, z3.Z3_OP_BXOR,
    }
)  # fmt: skip
"""Commutative operators."""
TURNED = {z3.Z3_OP_GE: z3.Z3_OP_LE, z3.Z3_OP_GT: z3.Z3_OP_LT}
"""Comparisons that are hashed with their sides exchanged: a >= b as b <= a."""


Known = dict[int, tuple[z3.ExprRef, str]]
"""Hashes by the term's id; the term is kept alive so that its id stays unique."""
_GIVEN: Known = {}
"""Hashes of the terms that were asked for, in the main context."""
_PARTS: Known = {}
"""Hashes of the simplified terms and of their subterms, in the main context."""


def canonical(term: z3.ExprRef) -> str:
    """The hash of the term's simplified form."""
    if term.ctx is not z3.main_ctx():
        return _hash(z3.simplify(term, som=True), {})
    found = _GIVEN.get(term.get_id())
    if found is None:
        found = _GIVEN[term.get_id()] = term, _hash(z3.simplify(term, som=True), _PARTS)
    return found[1]


def _hash(term: z3.ExprRef, known: Known) -> str:
    number = term.get_id()
    if number not in known:
        below = [_hash(child, known) for child in term.children()]
        known[number] = term, _node(term, below)
    return known[number][1]


def _node(term: z3.ExprRef, below: list[str]) -> str:
    operator = term.decl()
    kind = operator.kind()
    if kind in COMMUTE:
        below = sorted(below)
    if kind in TURNED:
        kind, below = TURNED[kind], below[::-1]
    name = str(kind)
    if not below:
        name = f"{kind} {term.sexpr()}"
    elif kind == z3.Z3_OP_UNINTERPRETED:
        name = f"{kind} {operator.name()}"
    parts = [name, term.sort().sexpr(), *map(str, operator.params()), *below]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()
