"""Arguments on which the readings of a function are compared: special numbers, grids, random ones.

All reals are doubles, so that each reading gets the same numbers. The order is the same in every run.
"""

from __future__ import annotations

import inspect
import math
import random
import sys
import types
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any, get_type_hints

from cratous.core.kernel.sources import reached
from cratous.proofs.mutation.inputs import inputs, shaped

Row = tuple[Any, ...]

EXACT = 2**53
REALS = (
    0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 3.0, 0.1, -0.1, 1e-3, 1e3, -1e6, float(EXACT - 1),
    float(EXACT), float(EXACT + 2), -float(EXACT), 5e-324, -5e-324, sys.float_info.min, 1e-200,
    2.0**31, 1e16, -1e16, 1e150,
)  # fmt: skip
INTEGERS = (
    0, 1, -1, 2, 3, 63, 64, 1000, -1000, 2**31 - 1, 2**31, EXACT - 1, EXACT, EXACT + 1, -EXACT,
    -EXACT - 1, 2**60, 2**61, -(2**61),
)  # fmt: skip
MASKS = (0, 1, 2, 3, 1 << 62, (1 << 62) - 1, 1 << 63, (1 << 64) - 1)
GRID, MIXED, WILD = 40, 40, 20
"""The number of rows of each kind: small grids, special numbers among plain ones, random doubles."""


def leaves_of(kinds: list[Any]) -> list[Any]:
    """The types of the scalars in arguments of these types, in order."""
    found: list[Any] = []
    for kind in kinds:
        fields = [] if kind in (bool, int, float) else list(get_type_hints(kind).values())
        found += leaves_of(fields) if fields else [kind]
    return found


def kinds_of(function: Callable[..., Any]) -> list[Any]:
    """The types of a function's parameters; KeyError where one has none."""
    hints = get_type_hints(function)
    return [hints[name] for name in inspect.signature(function).parameters]


def written(function: Callable[..., Any]) -> tuple[list[float], list[int]]:
    """The literals in a function and in what it calls, with neighbouring values: reals and integers."""
    numbers: list[Any] = []
    for value in reached(function).values():
        if isinstance(value, types.FunctionType):
            numbers += [v for const in value.__code__.co_consts for v in _scalars(const)]
        else:
            numbers += _scalars(value)
    reals: dict[float, None] = {}
    integers: dict[int, None] = {}
    for number in numbers:
        near = float(number)
        for real in (near, -near, near + 1, near - 1, _after(near), -_after(-near)):
            reals[real] = None
        if isinstance(number, int):
            integers |= dict.fromkeys((number, number + 1, number - 1))
    return list(reals), [n for n in integers if abs(n) <= 2**61]


def _after(value: float) -> float:
    return math.nextafter(value, math.inf)


def _scalars(value: Any) -> list[Any]:
    if isinstance(value, tuple | frozenset):
        return [number for part in value for number in _scalars(part)]
    plain = isinstance(value, int | float | Fraction) and not isinstance(value, bool)
    return [value] if plain and abs(value) < 10**300 else []


def rows(
    function: Callable[..., Any], masks: frozenset[int], more: Iterator[Row] | tuple[Row, ...] = ()
) -> list[Row]:
    """Argument tuples of a function; masks: positions of bit masks; more: rows from elsewhere."""
    kinds = kinds_of(function)
    flat = leaves_of(kinds)
    at_mask = _positions(kinds, masks)
    rng = random.Random(f"{function.__module__}.{function.__qualname__} in its readings")
    reals, integers = written(function)
    pools: dict[Any, list[Any]] = {
        float: [*REALS, *reals], int: [*INTEGERS, *integers], bool: [False, True],
    }  # fmt: skip

    def pool(number: int) -> list[Any]:
        return list(MASKS) if number in at_mask else pools[flat[number]]

    made: list[list[Any]] = []
    most = max((len(pool(k)) for k in range(len(flat))), default=1)
    for index in range(most):  # equal arguments: the same special number for all
        made.append([pool(k)[index % len(pool(k))] for k in range(len(flat))])
    for number in range(MIXED):
        few = rng.sample(range(len(flat)), min(len(flat), 1 + number % 3))
        base = [_plain(kind, k in at_mask, rng) for k, kind in enumerate(flat)]
        made.append([rng.choice(pool(k)) if k in few else base[k] for k in range(len(flat))])
    for _ in range(WILD):
        made.append([_wild(kind, k in at_mask, rng) for k, kind in enumerate(flat)])
    found = [shaped(kinds, iter(row)) for row in made]
    found += inputs(function, masks, GRID)
    found += [row for given in more for row in _in_doubles(given, len(kinds))]
    return found


def _in_doubles(row: Row, size: int) -> list[Row]:
    """The row with each rational rounded to a double, unless one is out of the range of doubles."""
    try:
        return [tuple(map(_double, row))] if len(row) == size else []
    except OverflowError:
        return []


def _double(value: Any) -> Any:
    if isinstance(value, tuple):
        return type(value)(*map(_double, value))
    return float(value) if isinstance(value, Fraction) else value


def _positions(kinds: list[Any], masks: frozenset[int]) -> set[int]:
    """The indices of bit masks among the scalars."""
    found, place = set(), 0
    for number, kind in enumerate(kinds):
        if number in masks:
            found.add(place)
        place += len(leaves_of([kind]))
    return found


def _plain(kind: Any, mask: bool, rng: random.Random) -> Any:
    if mask:
        return rng.getrandbits(3)
    if kind is bool:
        return rng.random() < 0.5
    return rng.randint(-3, 6) if kind is int else rng.randint(-8, 16) / 4


def _wild(kind: Any, mask: bool, rng: random.Random) -> Any:
    if mask:
        return rng.getrandbits(64)
    if kind is bool:
        return rng.random() < 0.5
    if kind is int:
        return rng.randint(-(10**9), 10**9)
    return rng.uniform(-1000.0, 1000.0)
