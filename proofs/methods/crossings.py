"""Premises shared by theorems on a leg's crossings: a span of the leg without a crossing."""

from __future__ import annotations

from typing import Any

from cratous.core.geofence.passages import crossing, foot
from cratous.proofs.claim import Claim


def undisturbed(c: Claim, p: Any, q: Any, a: Any, b: Any, low: Any, high: Any) -> None:
    """Premise: strictly between low and high the edge a-b has no crossing; nor the foot of an end, if parallel."""

    def not_between(ratio: Any) -> Any:
        return (ratio.num - low * ratio.den) * (ratio.num - high * ratio.den) >= 0

    at = c.use(crossing, p, q, a, b)
    c.premise(c.implies(at.den != 0, not_between(at)))
    for end in (a, b):
        c.premise(c.implies(at.den == 0, not_between(c.use(foot, p, q, end))))


def feet_named(c: Claim, p: Any, q: Any, a: Any, b: Any, s: Any, t: Any) -> None:
    """Premise: s and t are the parameters of the feet of a and b, 0 where the leg is a point."""
    for parameter, end in ((s, a), (t, b)):
        ratio = c.use(foot, p, q, end)
        c.premise(parameter * ratio.den == ratio.num)
        c.premise(c.implies(ratio.den == 0, parameter == 0))


def crossing_named(c: Claim, p: Any, q: Any, a: Any, b: Any, s: Any, t: Any) -> None:
    """Premise: s and t are the parameters of the lines' crossing on p-q and a-b (Cramer's rule)."""
    wx, wy, ux, uy = q.x - p.x, q.y - p.y, b.x - a.x, b.y - a.y
    k = wx * uy - wy * ux
    on_w = k * s == (a.x - p.x) * uy - (a.y - p.y) * ux
    on_u = k * t == (a.x - p.x) * wy - (a.y - p.y) * wx
    c.premise(c.implies(k != 0, c.all_of(on_w, on_u)))


def share(c: Claim, num: Any, den: Any) -> Any:
    """num / den, or 0 where den is 0."""
    return c.when(den == 0, den - den, num / c.when(den == 0, den - den + 1, den))
