"""How many values premises leave an argument: a theorem about a few numbers says nothing of the others.

First the statement is run (`proofs.running.nudged`); what that does not settle is asked of the solver. A real
must have two values that are one width apart: it is small, and made of the premises' hash, so where premises
leave a few numbers, or many that are apart, no two are. An integer must have two neighbours among its values,
or more than FEW of them; a mask more than FEW; a truth value both.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any

import z3

from cratous.proofs.engine.obligation_hash import Hasher
from cratous.proofs.engine.terms import free_values

Possible = Callable[[list[z3.BoolRef]], str]
"""sat, unsat or unknown."""
Another = Callable[[list[z3.BoolRef], z3.ExprRef], z3.ExprRef | None]
"""A value of a term where all of these hold; None where the solver finds none."""

Place = tuple[int, int]
"""An argument: the number of the use of a kernel in its theorem, and of the number among its arguments."""
Taken = Callable[[str, Mapping[Place, z3.ExprRef]], set[Place]]
"""Those arguments of some that are found to take many values by running the statement (`proofs.running.nudged`)
at numbers that are made of a hash of what it says."""

FEW = 8
"""An argument with no more values than these is told their number."""
APART_BITS, DIGEST_BITS = 64, 128
"""The width lies between half of 2**-APART_BITS and that; so many bits of it are the hash's."""


class Given:
    """Premises, and the same of other values."""

    def __init__(self, premises: Iterable[z3.BoolRef], possible: Possible) -> None:
        self.premises, self.possible = list(premises), possible

    def many(self, terms: list[z3.ExprRef]) -> set[int]:
        """Those terms that have two values as near as can be; all are asked at once first. Masks are counted."""
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
        """Which number it is, nobody chooses who states the premises: it is made of their hash.

        An interval has two numbers so far apart; a few numbers that are written down have not.
        """
        said = int(Hasher().key("width", [*self.premises, *terms]), 16) % 2**DIGEST_BITS
        return Fraction(2**DIGEST_BITS + said, 2 ** (DIGEST_BITS + APART_BITS + 1))

    def counts(self, terms: list[z3.ExprRef], another: Another) -> dict[int, int]:
        """How many values each term has that the solver finds, at most one more than FEW."""
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
    """These values of an argument are more than a few; how many a real has, a count does not say."""
    if z3.is_int(term) and any(value + 1 in values for value in values):
        return True
    return not z3.is_real(term) and len(values) > (1 if z3.is_bool(term) else FEW)


def _near(one: z3.ExprRef, other: z3.ExprRef, width: Fraction) -> z3.BoolRef:
    """Two values of a term are as near as can be, and differ."""
    if z3.is_real(one):
        return other == one + z3.Q(width.numerator, width.denominator)
    return other == one + 1 if z3.is_int(one) else one != other
