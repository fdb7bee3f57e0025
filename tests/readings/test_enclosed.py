"""The enclosed reading: it contains the value on rationals, narrowly, or refuses."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt, sqrt
from typing import NamedTuple

import numpy as np
import pytest

from cratous.core.kernel import Vec2
from cratous.core.readings.enclosed import enclosed
from cratous.spec.errors import BadInput


class Times(NamedTuple):
    """First and last time [s]."""

    first: float
    last: float


def tau_mod(s: Vec2, v: Vec2, dthr_m: float) -> float:
    """Modified tau [s]."""
    return (dthr_m * dthr_m - s.x * s.x - s.y * s.y) / (s.x * v.x + s.y * v.y)


def roots(a: float, b: float, c: float) -> Times:
    """The real roots of a t^2 + 2 b t + c, a > 0; (1, 0) if there are none."""
    disc = b * b - a * c
    if disc < 0:
        return Times(1, 0)
    root = sqrt(disc)
    return Times((0 - b - root) / a, (root - b) / a)


def unguarded(x: float) -> float:
    """A root that may be undefined."""
    return sqrt(x - 1)


def wrong_guard(x: float) -> float:
    """A guard that does not protect the root."""
    if x - 1 > 0 - 1:
        return sqrt(x - 1)
    return 0


def near(x: float, y: float) -> bool:
    """Whether a quotient is at most one."""
    return y != 0 and x / y <= 1


def mixed(x: float, y: float) -> float:
    """abs, min, max and a choice."""
    z = x
    if x * y < 0:
        z = 0 - x
    return max(abs(z - y), min(x, 2 * y)) * z


def contains(low, high, values) -> bool:
    return all(
        Fraction(a) <= v <= Fraction(b)
        for a, b, v in zip(low.tolist(), high.tolist(), values, strict=True)
    )


@pytest.mark.parametrize("scale", [0, -300, 300, -545])
def test_quotients_are_enclosed(scale: int) -> None:
    rng = np.random.default_rng(1)
    n = 500
    x, y = rng.normal(size=(2, n)) * 1000 * 2.0**scale
    u, v, d = -x / 30, -y / 31, rng.uniform(1, 100, n) * 2.0**scale
    rows = zip(*[c.tolist() for c in (x, y, u, v, d)], strict=True)
    wanted = []
    for row in rows:
        a, b, c, e, f = map(Fraction, row)
        wanted.append(tau_mod(Vec2(a, b), Vec2(c, e), f))
    if scale == -545:
        # the divisor underflows: nothing can be said, and that is said
        with pytest.raises(BadInput, match=r"tau_mod.*\[\d+\].*divides by what may be 0"):
            enclosed(tau_mod)(x, y, u, v, d)
        return
    low, high = enclosed(tau_mod)(x, y, u, v, d)
    assert contains(low, high, wanted)
    assert np.median((high - low) / np.abs(low)) < 1e-13


def test_roots_are_enclosed() -> None:
    rng = np.random.default_rng(2)
    n = 500
    a, b, c = rng.uniform(0.5, 2, n), rng.normal(size=n), rng.normal(size=n)
    clear = np.abs(b * b - a * c) > 1e-9
    a, b, c = a[clear], b[clear], c[clear]
    found = enclosed(roots)(a, b, c)
    assert isinstance(found, Times)
    first, last = [], []
    for p, q, r in zip(a.tolist(), b.tolist(), c.tolist(), strict=True):
        p, q, r = Fraction(p), Fraction(q), Fraction(r)
        disc = q * q - p * r
        if disc < 0:
            first.append(Fraction(1))
            last.append(Fraction(0))
            continue
        root = Fraction(
            isqrt(disc.numerator * disc.denominator * 4**200), disc.denominator * 2**200
        )
        first.append((-q - root) / p)
        last.append((root - q) / p)
    slack = Fraction(1, 2**150)  # of the rational root
    for pair, values in ((found.first, first), (found.last, last)):
        for low, high, value in zip(pair[0].tolist(), pair[1].tolist(), values, strict=True):
            assert Fraction(low) - slack <= value <= Fraction(high) + slack
            assert high - low < 1e-6


def test_an_uncertain_guard_covers_both_branches() -> None:
    # b^2 - a c is zero on rationals within rounding: no root, or one
    low, high = enclosed(roots)(3.0, 0.1, 0.01 / 3)[0]
    assert low <= -0.1 / 3 <= high
    assert high >= 1


def test_choices_are_enclosed() -> None:
    rng = np.random.default_rng(3)
    x, y = rng.normal(size=(2, 400))
    low, high = enclosed(mixed)(x, y)
    wanted = [mixed(Fraction(a), Fraction(b)) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
    assert contains(low, high, wanted)
    assert np.max(high - low) < 1e-13


def test_truth_values_are_sure_or_possible() -> None:
    y = np.array([2.0, 0.0, 3.0, 1.0])
    surely, possibly = enclosed(near)(np.array([1.0, 1.0, 9.0, 1.0]), y)
    assert surely.tolist() == [True, False, False, False]
    assert possibly.tolist() == [True, False, False, True]


@pytest.mark.parametrize("kernel", [unguarded, wrong_guard])
def test_undefined_roots_are_refused(kernel) -> None:
    assert enclosed(kernel)(np.array([5.0]))[0][0] == pytest.approx(2)
    with pytest.raises(BadInput, match="root of what may be negative") as caught:
        enclosed(kernel)(np.array([5.0, 4.0, 0.5]))
    assert caught.value.item == "[2]"


def test_what_is_not_finite_is_refused() -> None:
    with pytest.raises(BadInput, match=r"x\[1\].*finite"):
        enclosed(unguarded)(np.array([5.0, float("nan")]))
    with pytest.raises(BadInput, match="no finite enclosure"):
        enclosed(mixed)(1e300, 1e300)
