"""Definitions for edges, polygons, boundaries and zones; the topology.

A *polygon* is a simple closed chain of edges: at least three different vertices, and no two edges with a point in
common but the vertex that neighbours share. Its *boundary* is the union of its closed edges. A point off the boundary
is *inside* iff the open ray from it towards +x meets the chain an odd number of times, each edge counted without its
upper end. That the parity belongs to the point's side and not to the ray is proved: it does not change along any leg
that misses the boundary, and it changes where a leg passes through one edge (Jordan). Points of a segment are written
p + t (q - p), 0 <= t <= 1.

Every region is a pair of sets: its *open* part, without the boundary, and its *closed* part, with it. A *place* says
to which of the two a point belongs: 1 both, 0 the closed one alone (boundary), -1 neither (outside). A layer of
altitudes is open or closed together with its floor and ceiling. An intersection takes both parts of both regions, a
union those of either; subtracting a region intersects with its complement, whose open part is the outside of the
region's closed part. A keep-out forbids its closed part, a keep-in allows its open part: so a boundary is never
allowed.

Distances are Euclidean, to the nearest point of the closed edge or boundary, and stated in squares.
"""

from typing import NamedTuple


class Point(NamedTuple):
    """A point in the plane."""

    x: float
    y: float


class Count(NamedTuple):
    """The result of a pass over the edges: whether the point is on one, and how many the ray meets."""

    on: bool
    crossings: int


def along(p: Point, q: Point, t: float) -> Point:
    """The point of the line p-q at parameter t."""
    return Point(p.x + t * (q.x - p.x), p.y + t * (q.y - p.y))


def moved(p: Point, velocity: Point, t: float) -> Point:
    """The point that has moved straight at a velocity for a time t."""
    return Point(p.x + t * velocity.x, p.y + t * velocity.y)


def turn(a: Point, b: Point, c: Point) -> float:
    """Determinant of (b - a, c - a): positive for a left turn in an x-y frame."""
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)


def swept(a: Point, b: Point) -> float:
    """Twice the signed area between the edge a-b and the y axis: positive for an upward edge to the right of the
    axis.
    """
    return (a.x + b.x) * (b.y - a.y)


def swept_by_triangle(a: Point, b: Point, c: Point) -> float:
    """Twice the signed area of a triangle: the sum over its edges in order (Green)."""
    return swept(a, b) + swept(b, c) + swept(c, a)


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


def right_at(
    a: Point, b: Point, m: Point, velocity: Point, begin: float, end: float, t: float
) -> bool:
    """The moving point is right of the line from a to b at the instant t of [begin, end].

    m: the point at time 0. THERE IS an instant at which it is right of the line.
    """
    return t >= begin and t <= end and not left_of(moved(m, velocity, t), a, b)


def square_point_left_of(
    a: Point, b: Point, centre: Point, half: float, u: float, v: float
) -> bool:
    """The point of a square at (u, v), both in [-1, 1], is left of the line a-b or on it.

    The square has its sides along the axes; half: half of a side, at least 0.
    """
    return left_of(Point(centre.x + u * half, centre.y + v * half), a, b)


def every_step(so_far: bool, here: bool) -> bool:
    """One more item has been checked: does the condition hold for all so far?"""
    return so_far and here


def common_point(p: Point, q: Point, a: Point, b: Point, s: float, t: float) -> bool:
    """The point of p-q at s and the point of a-b at t are the same point of both segments."""
    one, other = along(p, q, s), along(a, b, t)
    inside = s >= 0 and s <= 1 and t >= 0 and t <= 1
    return inside and one.x == other.x and one.y == other.y


class Movement(NamedTuple):
    """A polygon that moves straight: its velocity, and the times at the beginning and end of a leg, since it stood
    where its vertices are given.
    """

    velocity: Point
    begin: float
    end: float


def moved_edge_met(
    p: Point, q: Point, a: Point, b: Point, movement: Movement, s: float, t: float
) -> bool:
    """The point of the leg p-q at s is, at the instant at which it is flown, the point of the moved edge a-b at t."""
    at = movement.begin + s * (movement.end - movement.begin)
    one = along(p, q, s)
    other = along(moved(a, movement.velocity, at), moved(b, movement.velocity, at), t)
    inside = s >= 0 and s <= 1 and t >= 0 and t <= 1
    return inside and one.x == other.x and one.y == other.y


def lines_meet_at(p: Point, q: Point, a: Point, b: Point, s: float, t: float) -> bool:
    """The point of the line p-q at s is the point of the line a-b at t."""
    one, other = along(p, q, s), along(a, b, t)
    return one.x == other.x and one.y == other.y


def altitude_in_keep_out(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude belongs to a keep-out's layer."""
    return floor <= alt and alt <= ceiling


def altitude_in_keep_in(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude lies strictly within a keep-in's layer."""
    return floor < alt and alt < ceiling


def enters_keep_out_at(place: int, meets: bool, alt: float, floor: float, ceiling: float) -> bool:
    """A leg that has this altitude at some point is, or may be, in a keep-out there.

    place: the horizontal place of its first point with respect to the zone; meets: it meets the zone's boundary.
    THERE IS an altitude of the leg at which it is not clear of the zone.
    """
    clear = not in_closed(place) and not meets
    return not clear and altitude_in_keep_out(alt, floor, ceiling)


def leaves_keep_in_at(place: int, meets: bool, alt: float, floor: float, ceiling: float) -> bool:
    """A leg that has this altitude at some point is not, or may not be, strictly within a keep-in there.

    Arguments as for `enters_keep_out_at`. THERE IS an altitude at which it is not within.
    """
    within = in_open(place) and not meets
    return not within or not altitude_in_keep_in(alt, floor, ceiling)


def any_step(found: bool, here: bool) -> bool:
    """One more item has been checked: does the condition hold for any so far?"""
    return found or here


def squared_distance(p: Point, m: Point) -> float:
    """The square of the distance between two points."""
    return (m.x - p.x) * (m.x - p.x) + (m.y - p.y) * (m.y - p.y)


def nearer_at(p: Point, a: Point, b: Point, d: float, t: float) -> bool:
    """The point of the closed segment a-b at parameter t is nearer to p than d."""
    return t >= 0 and t <= 1 and squared_distance(p, along(a, b, t)) < d * d


def within_at(p: Point, a: Point, b: Point, d: float, t: float) -> bool:
    """The point of the closed segment a-b at parameter t is no farther from p than d."""
    return t >= 0 and t <= 1 and squared_distance(p, along(a, b, t)) <= d * d


def legs_nearer_at(p: Point, q: Point, a: Point, b: Point, d: float, s: float, t: float) -> bool:
    """The points of p-q at s and of a-b at t are nearer to each other than d."""
    inside = s >= 0 and s <= 1 and t >= 0 and t <= 1
    return inside and squared_distance(along(p, q, s), along(a, b, t)) < d * d


def legs_within_at(p: Point, q: Point, a: Point, b: Point, d: float, s: float, t: float) -> bool:
    """The points of p-q at s and of a-b at t are no farther from each other than d."""
    inside = s >= 0 and s <= 1 and t >= 0 and t <= 1
    return inside and squared_distance(along(p, q, s), along(a, b, t)) <= d * d


def foot_at(p: Point, a: Point, b: Point, t: float) -> bool:
    """The point of the line a-b at parameter t is the foot of the perpendicular from p."""
    m = along(a, b, t)
    return (p.x - m.x) * (b.x - a.x) + (p.y - m.y) * (b.y - a.y) == 0


def sign(value: float) -> int:
    """-1, 0 or 1."""
    if value == 0:
        return 0
    if value > 0:
        return 1
    return -1


class Found(NamedTuple):
    """The result of a pass over the edges: whether one is nearer than the buffer, and whether one is no farther."""

    nearer: bool
    within: bool


def found_step(found: Found, nearer: bool, within: bool) -> Found:
    """Add one edge."""
    return Found(any_step(found.nearer, nearer), any_step(found.within, within))


def against(found: Found) -> int:
    """-1: a point of the boundary is nearer than the buffer; 0: none is nearer, but one is at the buffer distance; 1:
    all are farther.
    """
    if found.nearer:
        return -1
    if found.within:
        return 0
    return 1


class Least(NamedTuple):
    """The least number found in a pass, if any."""

    any: bool
    value: float


def least_step(least: Least, here: float) -> Least:
    """Add one number."""
    if least.any and least.value <= here:
        return least
    return Least(True, here)


def in_open(place: int) -> bool:
    """A point with this place belongs to the region's open part."""
    return place > 0


def in_closed(place: int) -> bool:
    """A point with this place belongs to the region's closed part."""
    return place >= 0


class Parts(NamedTuple):
    """The parts of a region to which a point belongs."""

    open: bool
    closed: bool


def place_of(parts: Parts) -> int:
    """1 in the open part, 0 in the closed one alone, -1 in neither."""
    if parts.open:
        return 1
    if parts.closed:
        return 0
    return -1


def in_open_layer(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude belongs to the open part of a layer."""
    return altitude_in_keep_in(alt, floor, ceiling)


def in_closed_layer(alt: float, floor: float, ceiling: float) -> bool:
    """The altitude belongs to the closed part of a layer."""
    return altitude_in_keep_out(alt, floor, ceiling)


def intersection(one: bool, other: bool) -> bool:
    """One part (open or closed) of an intersection, from the same parts of both regions."""
    return one and other


def union(one: bool, other: bool) -> bool:
    """One part (open or closed) of a union, from the same parts of both regions."""
    return one or other


def intersection_step(parts: Parts, open_: bool, closed: bool) -> Parts:
    """Add a region to an intersection."""
    return Parts(intersection(parts.open, open_), intersection(parts.closed, closed))


def union_step(parts: Parts, open_: bool, closed: bool) -> Parts:
    """Add a region to a union."""
    return Parts(union(parts.open, open_), union(parts.closed, closed))


def complement(other_part: bool) -> bool:
    """One part of a complement, from the other part of the region."""
    return not other_part


def widened(part: bool, near: bool) -> bool:
    """One part of a region widened by a distance: in it, or near it (open: nearer; closed: no farther)."""
    return part or near


def narrowed(part: bool, near: bool) -> bool:
    """One part of a region narrowed by a distance: in it, and not near its boundary (open: no farther; closed:
    nearer).
    """
    return part and not near


def altitude(p_alt: float, q_alt: float, t: float) -> float:
    """The altitude of a straight leg at parameter t."""
    return p_alt + t * (q_alt - p_alt)


def share_a_point(p: Point, q: Point, a: Point, b: Point, s: float, t: float, shared: bool) -> bool:
    """Two edges of a chain have this point in common, which those of a simple chain must not have.

    shared: p-q ends where a-b begins, so that the common point s = 1, t = 0 is permitted.
    """
    if shared and s == 1 and t == 0:
        return False
    return common_point(p, q, a, b, s, t)


def part_seen(part: float, unseen: float, whole: float) -> bool:
    """At least 99 per cent of the whole has been seen; the part seen is the whole less the part not seen. THERE IS
    such a part.
    """
    seen = part + unseen <= whole
    return seen and 100 * part >= 99 * whole
