"""Exact geometry in the plane, on the rationals that doubles represent.

Points are pairs of floats or of fractions. The sign of a determinant is computed in doubles where
its error bound permits (Shewchuk 1997: |error| < (3 + 16 u) u (|a| + |b|) with u = 2^-53, for a
determinant a - b of differences), otherwise in fractions. Point in polygon is by winding number.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

Pair = tuple[Any, Any]
ERROR = 4e-16
"""Above (3 + 16 u) u = 3.33e-16."""
LEAST = 1e-280
"""Below this, products may lose digits to underflow, so fractions decide."""


def turn(a: Pair, b: Pair, c: Pair) -> int:
    """1 if a, b, c turn counter-clockwise (first axis to second), -1 if clockwise, 0 if in line."""
    left, right = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    det = left - right
    if type(det) is float:
        bound = ERROR * (abs(left) + abs(right)) + LEAST
        if det > bound:
            return 1
        if det < -bound:
            return -1
        (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, p)) for p in (a, b, c))
        det = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (det > 0) - (det < 0)


def on_segment(p: Pair, a: Pair, b: Pair) -> bool:
    """Whether p lies on the closed segment a-b."""
    if not (min(a[0], b[0]) <= p[0] <= max(a[0], b[0])):
        return False
    if not (min(a[1], b[1]) <= p[1] <= max(a[1], b[1])):
        return False
    return turn(a, b, p) == 0


def meet(p: Pair, q: Pair, a: Pair, b: Pair) -> bool:
    """Whether the closed segments p-q and a-b have a point in common."""
    for k in (0, 1):
        if max(p[k], q[k]) < min(a[k], b[k]) or max(a[k], b[k]) < min(p[k], q[k]):
            return False
    one, two = turn(p, q, a), turn(p, q, b)
    three, four = turn(a, b, p), turn(a, b, q)
    if one * two < 0 and three * four < 0:
        return True
    return on_segment(a, p, q) or on_segment(b, p, q) or on_segment(p, a, b) or on_segment(q, a, b)


def winding(ring: Sequence[Pair], p: Pair) -> int | None:
    """Winding number of the ring around p; None on the boundary."""
    number = 0
    a = ring[-1]
    for b in ring:
        if a[1] <= p[1] < b[1]:
            side = turn(a, b, p)
            if side > 0:
                number += 1
            elif side == 0:
                return None
        elif b[1] <= p[1] < a[1]:
            side = turn(a, b, p)
            if side < 0:
                number -= 1
            elif side == 0:
                return None
        elif a[1] == b[1] == p[1] and min(a[0], b[0]) <= p[0] <= max(a[0], b[0]):
            return None
        if b[0] == p[0] and b[1] == p[1]:
            return None
        a = b
    return number


def fault_of_ring(ring: Sequence[Pair]) -> str:
    """Why these corners are not a simple polygon; empty if they are."""
    n = len(ring)
    if n < 3:
        return f"{n} corners"
    if len(set(ring)) < n:
        return "a corner stands twice"
    edges = [(ring[k], ring[(k + 1) % n]) for k in range(n)]
    order = sorted(range(n), key=lambda k: min(edges[k][0][0], edges[k][1][0]))
    for place, k in enumerate(order):
        p, q = edges[k]
        reach = max(p[0], q[0])
        for j in order[place + 1 :]:
            a, b = edges[j]
            if min(a[0], b[0]) > reach:
                break
            if (j - k) % n == 1:
                bad = on_segment(b, p, q) or on_segment(p, a, b)
            elif (k - j) % n == 1:
                bad = on_segment(a, p, q) or on_segment(q, a, b)
            else:
                bad = meet(p, q, a, b)
            if bad:
                return f"edges {k + 1} and {j + 1} meet"
    return ""


def squared_distance(p: Pair, a: Pair, b: Pair) -> Fraction:
    """Squared distance of a point from a closed segment, exact."""
    (px, py), (ax, ay), (bx, by) = (tuple(map(Fraction, x)) for x in (p, a, b))
    ux, uy, wx, wy = bx - ax, by - ay, px - ax, py - ay
    length = ux * ux + uy * uy
    t = min(max((wx * ux + wy * uy) / length, Fraction(0)), Fraction(1)) if length else Fraction(0)
    dx, dy = wx - t * ux, wy - t * uy
    return dx * dx + dy * dy


def squared_gap(p: Pair, q: Pair, a: Pair, b: Pair) -> Fraction:
    """Squared distance between two closed segments, exact."""
    if meet(p, q, a, b):
        return Fraction(0)
    return min(
        squared_distance(p, a, b),
        squared_distance(q, a, b),
        squared_distance(a, p, q),
        squared_distance(b, p, q),
    )
