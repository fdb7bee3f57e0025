"""Whether a theorem's premises leave an argument more than a few values; otherwise the theorem covers only those.

The statement is run first (`proofs.running.nudged`); what that leaves open goes to the solver. A real must have two
values that differ by exactly one given width, a small number derived from a hash of the premises: premises that leave
a few isolated numbers do not have such a pair. An integer must have two consecutive values, or more than FEW values;
a mask more than FEW values; a truth value both.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

import z3

from cratous.proofs.engine.obligation_hash import Hasher
from cratous.proofs.engine.terms import free_values

Possible = Callable[[list[z3.BoolRef]], str]
"""Decides whether conditions are satisfiable: sat, unsat or unknown."""
Another = Callable[[list[z3.BoolRef], z3.ExprRef], z3.ExprRef | None]
"""A value of a term under these conditions; None where the solver finds none."""

Place = tuple[int, int]
"""An argument: index of the use of a kernel in its theorem, and index among that use's arguments."""
Taken = Callable[[str, Mapping[Place, z3.ExprRef]], set[Place]]
"""The arguments, among those given, that take many values when the statement is run (`proofs.running.nudged`) at
numbers derived from a hash of the statement."""

FEW = 8
"""An argument with at most this many values is reported with their number."""
APART_BITS, DIGEST_BITS = 64, 128
"""The width lies between half of 2**-APART_BITS and 2**-APART_BITS; DIGEST_BITS bits of it come from the hash."""


class Given:
    """Premises, and whether conditions are satisfiable under them."""

    def __init__(self, premises: Iterable[z3.BoolRef], possible: Possible) -> None:
        self.premises, self.possible = list(premises), possible

    def many(self, terms: list[z3.ExprRef]) -> set[int]:
        """Ids of the terms with two neighbouring values (see `_near`); first one query for all terms. Masks are
        skipped."""
        terms = [term for term in terms if not z3.is_bv(term)]
        values = free_values([*self.premises, *terms])
        others = [(v, z3.Const(f"{v}!other", v.sort())) for v in values]
        twice = [*self.premises, *[z3.substitute(one, *others) for one in self.premises]]
        width = self._width(terms)
        apart = {t.get_id(): _near(t, z3.substitute(t, *others), width) for t in terms}
        if self.possible([*twice, *apart.values()]) == "sat":
            return set(apart)
        if len(apart) == 1:
            return set()
        return {key for key, near in apart.items() if self.possible([*twice, near]) == "sat"}

    def _width(self, terms: list[z3.ExprRef]) -> Fraction:
        """The distance between two values of a real, derived from a hash so that premises cannot be fitted to it.

        An interval contains two numbers at this distance; a few numbers written down do not.
        """
        said = int(Hasher().key("width", [*self.premises, *terms]), 16) % 2**DIGEST_BITS
        return Fraction(2**DIGEST_BITS + said, 2 ** (DIGEST_BITS + APART_BITS + 1))

    def counts(self, terms: list[z3.ExprRef], another: Another) -> dict[int, int]:
        """The number of values found for each term by its id, at most FEW + 1."""
        return {term.get_id(): self._count(term, another) for term in terms}

    def _count(self, term: z3.ExprRef, another: Another) -> int:
        found: list[z3.ExprRef] = []
        while len(found) <= FEW:
            value = another([*self.premises, *[term != one for one in found]], term)
            if value is None:
                break
            found.append(value)
        return len(found)


def enough(term: z3.ExprRef, values: set[Any]) -> bool:
    """Whether these values of an argument are more than a few; never for a real, which a count cannot decide."""
    if z3.is_int(term) and any(value + 1 in values for value in values):
        return True
    return not z3.is_real(term) and len(values) > (1 if z3.is_bool(term) else FEW)


def _near(one: z3.ExprRef, other: z3.ExprRef, width: Fraction) -> z3.BoolRef:
    """Two values of a term are neighbours: apart by `width` for a real, by 1 for an integer, else merely different."""
    if z3.is_real(one):
        return other == one + z3.Q(width.numerator, width.denominator)
    return other == one + 1 if z3.is_int(one) else one != other
