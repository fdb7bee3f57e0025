"""Whether two functions have the same formula."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from cratous.proofs.statements.restated import restates


class Point(NamedTuple):
    x: float
    y: float


class Place(NamedTuple):
    east: float
    north: float


ONE, LIMIT = 1, 1


def within(value: float) -> bool:
    return value <= ONE


def _area(p: Point, q: Point) -> float:
    return p.x * q.y - p.y * q.x


def _swept(a: Place, b: Place) -> float:
    crossed = b.east * a.north
    return b.north * a.east - crossed


def _both(a: float, b: float) -> bool:
    if a > ONE:
        return False
    return 2 * b + a >= b + 1


def _neither_not(x: float, y: float) -> bool:
    return LIMIT + y <= x + y * 2 and within(x)


def _moved(p: Point, far: bool) -> Point:
    if far:
        return Point(p.x + 1, p.y)
    return p


def _moved_too(at: Place, far: bool) -> Place:
    return Place(1 + at.east if far else at.east, at.north)


def _least(a: float, b: float) -> float:
    return min(a, b, 0)


def _least_too(a: float, b: float) -> float:
    return min(0, min(b, a))


def _by_root(a: float, b: float) -> float:
    return math.sqrt(a * a + b * b)


def _by_loop(a: float, b: float) -> float:
    for _ in range(3):
        a = a + b
    return a


@pytest.mark.parametrize(
    ("one", "other"),
    [(_area, _swept), (_both, _neither_not), (_moved, _moved_too), (_least, _least_too)],
)
def test_one_formula_in_two_ways(one: object, other: object) -> None:
    assert restates(one, other)


def _area_turned(a: Place, b: Place) -> float:
    return b.east * a.north - a.east * b.north


def _strictly(x: float, y: float) -> bool:
    return LIMIT + y < x + y * 2 and within(x)


def _moved_north(at: Place, far: bool) -> Place:
    return Place(at.east, 1 + at.north if far else at.north)


def _largest(a: float, b: float) -> float:
    return max(0, max(b, a))


@pytest.mark.parametrize(
    ("one", "other"),
    [(_area, _area_turned), (_both, _strictly), (_moved, _moved_north), (_least, _largest)],
)
def test_two_formulas(one: object, other: object) -> None:
    assert restates(one, other) is False


def test_what_is_no_formula_is_not_compared() -> None:
    assert restates(_by_loop, _by_loop) is None
    assert restates(_by_root, _by_root) is None
