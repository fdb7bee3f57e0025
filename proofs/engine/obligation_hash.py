"""A structural hash of an obligation, over the raw solver terms.

The text of an obligation does not serve: the solver's printer puts internal numbers into names and orders operands by
them. Here a term is hashed from its operator, its parameters, its sort and the hashes of its operands in order;
variables count by the order of their first occurrence, so renaming changes nothing. One `Hasher` serves all
obligations of a theorem, so shared subterms are hashed once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

import z3


class Hasher:
    """Hashes terms that share their variables: one object for one theorem."""

    def __init__(self) -> None:
        self._known: dict[int, bytes] = {}
        self._variables: dict[int, int] = {}
        # terms are kept alive, or their ids would be reused for others
        self._kept: list[z3.AstRef] = []

    def add(self, root: z3.ExprRef) -> bytes:
        """The hash of a term."""
        todo = [root]
        while todo:
            term = todo[-1]
            number = term.get_id()
            if number in self._known:
                todo.pop()
                continue
            below = [term.body()] if z3.is_quantifier(term) else term.children()
            waiting = [child for child in below if child.get_id() not in self._known]
            if waiting:
                # left to right, so that variables are met in a fixed order
                todo += reversed(waiting)
                continue
            todo.pop()
            self._kept.append(term)
            self._known[number] = self._node(term, [self._known[c.get_id()] for c in below])
        return self._known[root.get_id()]

    def _node(self, term: z3.ExprRef, below: list[bytes]) -> bytes:
        sha = hashlib.sha256()
        for part in (*self._head(term), str(len(below))):
            sha.update(part.encode() + b"\0")
        for child in below:
            sha.update(child)
        return sha.digest()

    def _head(self, term: z3.ExprRef) -> list[str]:
        sort = term.sort().sexpr()
        if z3.is_quantifier(term):
            bound = [term.var_sort(k).sexpr() for k in range(term.num_vars())]
            return ["forall" if term.is_forall() else "exists", *bound]
        if z3.is_var(term):
            return ["bound", str(z3.get_var_index(term)), sort]
        operator = term.decl()
        if operator.kind() == z3.Z3_OP_UNINTERPRETED:
            number = self._variables.setdefault(operator.get_id(), len(self._variables))
            self._kept.append(operator)
            return ["free", str(number), sort]
        if z3.is_int_value(term) or z3.is_rational_value(term) or z3.is_bv_value(term):
            return ["value", str(term), sort]
        return [str(operator.kind()), operator.name(), sort, *map(str, operator.params())]

    def key(self, kind: str, terms: Iterable[z3.ExprRef]) -> str:
        """One hash over terms in order; kind says what is asked of them."""
        sha = hashlib.sha256(kind.encode())
        for term in terms:
            sha.update(self.add(term))
        return sha.hexdigest()
