"""The distance of a point or a leg from an edge and from a boundary: exact, in squares. No division.

Definitions: `spec.geofence`. Whether a point is nearer than a buffer, at it, or farther follows from the invariants
of the edge with respect to the point (`Foot`); which feature of the edge is nearest, an end or the foot of the
perpendicular, is decided without division. The squared distance itself is a ratio of two numbers that the kernels
give exactly.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.geofence.planar import orient, segments_meet
from cratous.core.kernel import Vec2, fold, kernel

NEARER, AT, FARTHER = -1, 0, 1


class Ratio(NamedTuple):
    """num / den with den >= 0; den = 0 with num = 1 represents infinity."""

    num: float
    den: float


@kernel(implements="geofence.foot_at")
def ahead(p: Vec2, a: Vec2, b: Vec2) -> float:
    """The position of p along the edge from a towards b, times the edge's length; any one unit."""
    return (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)


@kernel(
    implements="geofence.squared_distance",
    restates="the square of a Euclidean distance, by which distances are compared",
)
def apart_squared(p: Vec2, m: Vec2) -> float:
    """The squared distance of two points; any one unit."""
    return (m.x - p.x) * (m.x - p.x) + (m.y - p.y) * (m.y - p.y)


@kernel(implements="geofence.sign")
def sign_of(value: float) -> int:
    """-1, 0 or 1 for a negative number, zero, a positive one."""
    if value < 0:
        return -1
    if value > 0:
        return 1
    return 0


@kernel(implements="geofence.squared_distance")
def edge_distance(p: Vec2, a: Vec2, b: Vec2) -> Ratio:
    """The squared distance from p to the closed edge a-b, as a ratio.

    Nearest is a, or b, or the foot of the perpendicular, whose squared distance is the squared
    turn over the squared length.
    """
    if ahead(p, a, b) <= 0:
        return Ratio(apart_squared(p, a), 1)
    if ahead(p, b, a) <= 0:
        return Ratio(apart_squared(p, b), 1)
    return Ratio(orient(a, b, p) * orient(a, b, p), apart_squared(a, b))


@kernel(implements="geofence.within_at")
def edge_against(p: Vec2, a: Vec2, b: Vec2, d_m: float) -> int:
    """-1 if the closed edge a-b is nearer to p than d_m, 0 if at d_m, 1 if farther.

    d_m: the buffer, >= 0, in the unit of the points.
    """
    squared = edge_distance(p, a, b)
    return sign_of(squared.num - d_m * d_m * squared.den)


@kernel(implements="geofence.found_step")
def nearest_step(least: int, a: Vec2, b: Vec2, p: Vec2, d_m: float) -> int:
    """The least of the verdicts so far and that for the edge a-b."""
    return min(least, edge_against(p, a, b, d_m))


boundary_against = fold(
    name="boundary_against", implements="geofence.against", step=nearest_step, start=1
)


@kernel(supports="boundary_distance")
def lesser(one: Ratio, other: Ratio) -> Ratio:
    """The lesser of two ratios; the first of two equal ones."""
    if one.num * other.den <= other.num * one.den:
        return one
    return other


@kernel(supports="boundary_distance")
def distance_step(least: Ratio, a: Vec2, b: Vec2, p: Vec2) -> Ratio:
    """The least squared distance so far, and that of the edge a-b."""
    return lesser(least, edge_distance(p, a, b))


boundary_distance = fold(
    name="boundary_distance",
    implements="geofence.least_step",
    step=distance_step,
    start=Ratio(1, 0),
)


@kernel(supports="leg_within")
def ends_against(p: Vec2, q: Vec2, a: Vec2, b: Vec2, d_m: float) -> int:
    """The least of four verdicts: of each end of p-q and of a-b against the other segment.

    d_m: the buffer, >= 0, in the unit of the points.
    """
    leg = min(edge_against(p, a, b, d_m), edge_against(q, a, b, d_m))
    edge = min(edge_against(a, p, q, d_m), edge_against(b, p, q, d_m))
    return min(leg, edge)


@kernel(implements="geofence.legs_nearer_at")
def leg_nearer(p: Vec2, q: Vec2, a: Vec2, b: Vec2, d_m: float) -> bool:
    """True iff some point of the leg p-q is nearer than d_m to some point of the edge a-b.

    d_m: the buffer, > 0, in the unit of the points. Two segments that do not meet are nearest at
    an end of one of them.
    """
    return segments_meet(p, q, a, b) or ends_against(p, q, a, b, d_m) < 0


@kernel(implements="geofence.legs_within_at")
def leg_within(p: Vec2, q: Vec2, a: Vec2, b: Vec2, d_m: float) -> bool:
    """True iff some point of the leg p-q is no farther than d_m from some point of the edge a-b.

    d_m: the buffer, >= 0, in the unit of the points.
    """
    return segments_meet(p, q, a, b) or ends_against(p, q, a, b, d_m) <= 0


@kernel(implements="geofence.any_step")
def approach_step(near: bool, a: Vec2, b: Vec2, p: Vec2, q: Vec2, d_m: float) -> bool:
    """Add the edge a-b to whether the leg p-q comes within d_m of the boundary."""
    return near or leg_within(p, q, a, b, d_m)


comes_within = fold(
    name="comes_within", implements="geofence.any_step", step=approach_step, start=False
)
