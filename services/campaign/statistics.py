"""Rates with exact binomial intervals, paired comparison of two options, and distributions.

Intervals are Clopper-Pearson, rounded outwards to a millionth, so that their coverage is at least
as stated. They apply only to independent draws from the sampled distribution.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import ceil, comb, exp, fsum, lgamma, log, log1p
from typing import Any

LEVEL = 0.95
GRID = 1_000_000
SLACK = 1e-9
"""Relative bound on rounding errors of a tail sum; tails are enlarged by it."""
QUANTILES = (0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0)


def tail(low: int, high: int, n: int, p: float) -> float:
    """Probability of low to high successes (both included) in n draws with probability p."""
    if p <= 0.0:
        return 1.0 if low <= 0 <= high else 0.0
    if p >= 1.0:
        return 1.0 if low <= n <= high else 0.0
    whole, yes, no = lgamma(n + 1), log(p), log1p(-p)
    return fsum(
        exp(whole - lgamma(k + 1) - lgamma(n - k + 1) + k * yes + (n - k) * no)
        for k in range(low, high + 1)
    )


def interval(k: int, n: int, level: float = LEVEL) -> tuple[float, float]:
    """Two-sided confidence interval of the rate for k observed in n draws; (0, 1) without draws."""
    half = (1 - level) / 2
    return lower(k, n, half), upper(k, n, half)


def lower(k: int, n: int, alpha: float) -> float:
    """The greatest grid rate for which k or more of n have probability at most alpha."""
    if k == 0:
        return 0.0
    return _last(lambda p: tail(k, n, n, p) * (1 + SLACK) <= alpha) / GRID


def upper(k: int, n: int, alpha: float) -> float:
    """The least grid rate for which k or fewer of n have probability at most alpha."""
    if k == n:
        return 1.0
    return 1 - _last(lambda q: tail(n - k, n, n, q) * (1 + SLACK) <= alpha) / GRID


def _last(fits: Callable[[float], bool]) -> int:
    """The last grid point that fits, if all points before it fit."""
    low, high = 0, GRID
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if fits(middle / GRID) else (low, middle)
    return low


def rate(k: int, n: int, random: bool) -> dict[str, Any]:
    """k of n as plain data: the share and, for random draws, the interval of the rate.

    at_most: one-sided bound if none was observed.
    """
    found: dict[str, Any] = {"count": k, "of": n, "share": k / n if n else None}
    if random and n:
        low, high = interval(k, n)
        found["interval"] = [round(low, 6), round(high, 6)]
        if k == 0:
            found["at_most"] = round(upper(0, n, 1 - LEVEL), 6)
    return found


def paired(pairs: Sequence[tuple[bool, bool]], random: bool) -> dict[str, Any]:
    """Two options on the same runs: pairs (holds under the first, holds under the second).

    p_value: of the exact two-sided test (McNemar) that a run that holds under one option only is
    equally likely to hold under either.
    """
    first = sum(a and not b for a, b in pairs)
    second = sum(b and not a for a, b in pairs)
    found: dict[str, Any] = {
        "pairs": len(pairs),
        "both": sum(a and b for a, b in pairs),
        "first_only": first,
        "second_only": second,
        "neither": sum(not a and not b for a, b in pairs),
    }
    if random:
        found["p_value"] = sign_test(first, second)
    return found


def sign_test(first: int, second: int) -> float:
    """Two-sided exact probability of a split at least as uneven, if both sides are equally likely."""
    n, less = first + second, min(first, second)
    weight = sum(comb(n, k) for k in range(less + 1))
    return min(1.0, float(Fraction(2 * weight, 2**n)))


def distribution(values: Sequence[float]) -> dict[str, Any]:
    """Quantiles of the values; each is an observed value (nearest rank)."""
    if not values:
        return {"count": 0, "quantiles": []}
    ranked = sorted(values)
    return {
        "count": len(ranked),
        "quantiles": [[q, ranked[max(0, ceil(q * len(ranked)) - 1)]] for q in QUANTILES],
    }
