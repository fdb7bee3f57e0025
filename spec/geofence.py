"""What it means to be on an edge, inside a polygon, in contact with its boundary.

A polygon is a simple closed chain of edges. Its boundary is the union of its closed edges. A point
off the boundary is inside iff the open ray from it towards +x meets the chain an odd number of
times, each edge counted without its upper end (Jordan: the parity does not depend on the ray).
Points of a segment are written p + t (q - p), 0 <= t <= 1. A keep-out contains its boundary, a
keep-in does not; floor and ceiling belong to the zone's boundary too.
"""

from typing import NamedTuple


class Point(NamedTuple):
    """A point in the plane."""

    x: float
    y: float


class Count(NamedTuple):
    """What a pass over the edges has found: is the point on one, and how many the ray meets."""

    on: bool
    crossings: int


def along(p: Point, q: Point, t: float) -> Point:
    """The point of the line p-q at parameter t."""
    return Point(p.x + t * (q.x - p.x), p.y + t * (q.y - p.y))


def turn(a: Point, b: Point, c: Point) -> float:
    """Determinant of (b - a, c - a): positive for a left turn in an x-y frame."""
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)


def on_segment_at(p: Point, a: Point, b: Point, t: float) -> bool:
    """p is the point of the closed segment a-b at parameter t."""
    at = along(a, b, t)
    return t >= 0 and t <= 1 and at.x == p.x and at.y == p.y


def crosses_ray(p: Point, a: Point, b: Point) -> bool:
    """The edge a-b without its upper end meets the open ray from p towards +x."""
    if a.y == b.y:
        return False
    t = (p.y - a.y) / (b.y - a.y)
    if not (t >= 0 and t <= 1):
        return False
    if a.y < b.y and t == 1:
        return False
    if b.y < a.y and t == 0:
        return False
    return along(a, b, t).x > p.x


def count_step(count: Count, on_edge: bool, a: Point, b: Point, p: Point) -> Count:
    """Add one edge to the count; on_edge: p is a point of it."""
    if crosses_ray(p, a, b):
        return Count(count.on or on_edge, count.crossings + 1)
    return Count(count.on or on_edge, count.crossings)


def location(count: Count) -> int:
    """0 on the boundary, 1 inside, -1 outside."""
    if count.on:
        return 0
    if count.crossings % 2 == 1:
        return 1
    return -1


def left_of(p: Point, a: Point, b: Point) -> bool:
    """p lies to the left of the line from a to b, or on it."""
    return turn(a, b, p) >= 0


def square_point_left_of(
    a: Point, b: Point, centre: Point, half: float, u: float, v: float
) -> bool:
    """The point of a square at (u, v), both in [-1, 1], is left of the line a-b or on it.

    The square has its sides along the axes; half: half of a side, at least 0.
    """
    return left_of(Point(centre.x + u * half, centre.y + v * half), a, b)


def every_step(so_far: bool, here: bool) -> bool:
    """One more place has been looked at: does it hold in all so far?"""
    return so_far and here


def every_result(so_far: bool) -> bool:
    """Whether it holds everywhere."""
    return so_far


def common_point(p: Point, q: Point, a: Point, b: Point, s: float, t: float) -> bool:
    """The point of p-q at s and the point of a-b at t are the same point of both segments."""
    one, other = along(p, q, s), along(a, b, t)
    inside = s >= 0 and s <= 1 and t >= 0 and t <= 1
    return inside and one.x == other.x and one.y == other.y


def altitude_in_keep_out(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude belongs to a keep-out's layer."""
    return floor <= alt and alt <= ceiling


def altitude_in_keep_in(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude lies strictly within a keep-in's layer."""
    return floor < alt and alt < ceiling


def any_step(found: bool, here: bool) -> bool:
    """One more place has been looked at: was it found in any so far?"""
    return found or here


def any_result(found: bool) -> bool:
    """Whether it was found anywhere."""
    return found
