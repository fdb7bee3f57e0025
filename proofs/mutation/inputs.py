"""Inputs on which a mutant is run beside its original: small grids, so that ties are frequent.

A fault at a boundary shows only on the boundary, which random doubles practically do not hit; on a grid of a few
small numbers comparisons meet equality often. The numbers are exact (integers and rationals), drawn in the same order
in every run.
"""

from __future__ import annotations

import inspect
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, get_type_hints

SAMPLES = 3000
ENOUGH = 24
"""The number of distinguishing inputs that are kept as starting points for the solver."""

STILLBORN = (TypeError, NameError, AttributeError, RecursionError)


def inputs(
    function: Callable[..., Any], masks: frozenset[int], count: int
) -> list[tuple[Any, ...]]:
    """`count` argument tuples; `masks`: positions of arguments that are bit masks."""
    hints = get_type_hints(function)
    kinds = [hints[name] for name in inspect.signature(function).parameters]
    rng = random.Random(f"{function.__module__}.{function.__name__}")
    made = []
    for number in range(count):
        # a reach of 0 gives a grid of three numbers, where points coincide and lines are parallel
        reach = (0, 1, 2, 3, 6)[number % 5]
        row = [_draw(k, rng, reach, at in masks, top=True) for at, k in enumerate(kinds)]
        made.append(tuple(row))
    return made


def _draw(kind: Any, rng: random.Random, reach: int, mask: bool, *, top: bool) -> Any:
    if mask:
        return rng.choice((0, 1, 2, 3, 4, 6, 1 << rng.randrange(64), rng.getrandbits(64)))
    if kind is bool:
        return rng.random() < 0.5
    if kind is int:
        return rng.randint(-reach, reach + 3)
    if kind is float and reach == 0:
        return Fraction(rng.randint(0, 2))
    if kind is float:
        value = Fraction(rng.randint(-2 * reach, 2 * reach), rng.choice((1, 1, 1, 2)))
        # scalar arguments of kernels are thresholds and times, mostly not negative
        return abs(value) if top and rng.random() < 0.7 else value
    fields = get_type_hints(kind)
    return kind(*[_draw(fields[f], rng, reach, False, top=False) for f in fields])


def shaped(kinds: list[Any], values: Iterator[Any]) -> tuple[Any, ...]:
    """Arguments of these types, built from their scalars in order."""
    row = []
    for kind in kinds:
        fields = [] if kind in (bool, int, float) else list(get_type_hints(kind).values())
        row.append(kind(*shaped(fields, values)) if fields else next(values))
    return tuple(row)


@dataclass(frozen=True)
class Difference:
    """Inputs on which a mutant and its original differ, or why the mutant cannot be run."""

    inputs: tuple[tuple[Any, ...], ...] = ()
    stillborn: str = ""


def run(function: Callable[..., Any], row: tuple[Any, ...]) -> Any:
    """The function's result, or the name of the arithmetic error that it raised."""
    try:
        return function(*row)
    except (ZeroDivisionError, ValueError, OverflowError) as error:
        return type(error).__name__


def compare(
    mutant: Callable[..., Any], rows: list[tuple[Any, ...]], results: list[Any]
) -> Difference:
    """Run the mutant on these inputs and compare with the original's results."""
    found = []
    for row, wanted in zip(rows, results, strict=True):
        try:
            got = run(mutant, row)
        except STILLBORN as error:
            return Difference(stillborn=f"{type(error).__name__}: {error}")
        if got != wanted or (type(got) is bool and type(wanted) is not bool):
            found.append(row)
            if len(found) == ENOUGH:
                break
    return Difference(tuple(found))
