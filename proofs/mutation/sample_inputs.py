"""Inputs of a function that theorems allow, found by drawing values for the theorems' variables.

A function of derived values (a dot product, a squared distance) has few inputs that correspond to some state, and
whether a given input is one of them is a hard question. So small values are drawn for the theorem's variables; where
its premises hold, the arguments of the call are an allowed input, and the values make it easy to decide whether the
theorem is refuted there.
"""

from __future__ import annotations

import inspect
import random
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, get_type_hints

import z3

from cratous.proofs.engine.lift import Visit
from cratous.proofs.engine.terms import free_values, known
from cratous.proofs.mutation.inputs import shaped
from cratous.proofs.mutation.solver_queries import number
from cratous.proofs.mutation.terms import flat

TRIES, KEPT = 60, 25
"""The number of draws for one call of a theorem, and of inputs that are kept."""


@dataclass(frozen=True)
class Point:
    """An input that a theorem allows, and values of the theorem at which it occurs."""

    row: tuple[Any, ...]
    theorem: str
    values: tuple[z3.BoolRef, ...]


def points(
    function: Callable[..., Any], theorem: str, premises: list[z3.BoolRef], visit: Visit
) -> list[Point]:
    """Allowed inputs of this call, in a fixed order; none where no draw satisfies the premises."""
    kinds = [get_type_hints(function)[name] for name in inspect.signature(function).parameters]
    args = [known(leaf) for leaf in flat(visit.args)]
    conditions = [*premises, *visit.context, *visit.granted]
    free = free_values([*args, *conditions])
    if any(_draw(one, random.Random(0), 1) is None for one in free):
        return []
    rng = random.Random(f"{theorem} {function.__name__}")
    found: list[Point] = []
    for draw in range(TRIES):
        reach = (1, 2, 3, 6)[draw % 4]
        pairs = [(one, _draw(one, rng, reach)) for one in free]
        if not all(z3.is_true(z3.simplify(z3.substitute(c, *pairs))) for c in conditions):
            continue
        values = [number(z3.simplify(z3.substitute(arg, *pairs))) for arg in args]
        if None not in values:
            equations = tuple(one == value for one, value in pairs)
            found.append(Point(shaped(kinds, iter(values)), theorem, equations))
        if len(found) == KEPT:
            break
    return found


def _draw(one: z3.ExprRef, rng: random.Random, reach: int) -> z3.ExprRef | None:
    """A small value of this sort, mostly not negative; None for sorts that are not numbers."""
    if z3.is_bool(one):
        return z3.BoolVal(rng.random() < 0.5)
    if z3.is_int(one):
        return z3.IntVal(rng.randint(-reach, reach + 3))
    if z3.is_bv(one):
        return z3.BitVecVal(rng.choice((0, 1, 2, 3, 4, 6, 1 << rng.randrange(64))), one.size())
    if not z3.is_real(one):
        return None
    value = Fraction(rng.randint(-2 * reach, 2 * reach), rng.choice((1, 1, 1, 2)))
    return z3.RealVal(str(abs(value) if rng.random() < 0.6 else value))
