"""Intervals against exact arithmetic and published values, tests against enumeration."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import comb

import pytest

from cratous.services.campaign.statistics import (
    distribution,
    interval,
    paired,
    rate,
    sign_test,
    upper,
)


def exactly(low: int, high: int, n: int, p: float) -> Fraction:
    """Probability of low to high successes in n draws, on rationals."""
    q = Fraction(p)
    return sum((comb(n, k) * q**k * (1 - q) ** (n - k) for k in range(low, high + 1)), Fraction(0))


@pytest.mark.parametrize(
    ("k", "n"), [(0, 1), (1, 1), (0, 20), (3, 20), (10, 20), (20, 20), (7, 150)]
)
def test_intervals_cover_and_are_not_wider_than_the_grid(k: int, n: int) -> None:
    low, high = interval(k, n)
    half = Fraction(1, 40)
    if k:
        assert exactly(k, n, n, low) <= half
        assert exactly(k, n, n, low + 3e-6) > half
    else:
        assert low == 0
    if k < n:
        assert exactly(0, k, n, high) <= half
        assert exactly(0, k, n, high - 3e-6) > half
    else:
        assert high == 1


def test_intervals_are_the_published_ones() -> None:
    # Clopper and Pearson 1934; the values stand in many tables
    assert interval(3, 10) == pytest.approx((0.066740, 0.652453), abs=2e-6)
    assert interval(0, 10) == pytest.approx((0, 0.308497), abs=2e-6)
    assert upper(0, 100, 0.05) == pytest.approx(0.029513, abs=2e-6)


def test_large_samples_are_quick_and_ordered() -> None:
    low, high = interval(12, 10_000)
    assert low < 0.0012 < high
    assert interval(13, 10_000)[0] > low


def test_a_rate_of_none_is_a_bound_and_of_no_draws_a_count() -> None:
    assert rate(0, 1000, random=True)["at_most"] == pytest.approx(0.002992, abs=2e-6)
    assert "interval" not in rate(0, 1000, random=False)
    assert rate(0, 0, random=True) == {"count": 0, "of": 0, "share": None}


@pytest.mark.parametrize("n", [0, 1, 5, 8])
def test_the_sign_test_is_what_counting_gives(n: int) -> None:
    for first in range(n + 1):
        far = abs(2 * first - n)
        as_far = sum(abs(2 * sum(s) - n) >= far for s in product((0, 1), repeat=n))
        assert sign_test(first, n - first) == pytest.approx(as_far / 2**n)


def test_pairs_are_counted() -> None:
    pairs = [(True, True), (True, False), (True, False), (False, False), (False, True)]
    found = paired(pairs, random=True)
    assert [found[k] for k in ("both", "first_only", "second_only", "neither")] == [1, 2, 1, 1]
    assert found["p_value"] == 1.0


def test_quantiles_are_values_that_were_seen() -> None:
    found = dict(distribution([float(v) for v in range(1, 101)])["quantiles"])
    assert (found[0.0], found[0.05], found[0.5], found[1.0]) == (1, 5, 50, 100)
    assert distribution([])["quantiles"] == []
