"""Points, legs and polygons in the plane: orientation, containment, contact. No division.

Definitions: `spec.geofence`. A polygon is the tuple of its edges (a, b) in order, simple, either orientation.
Containment is even-odd with half-open edges, with the boundary handled separately; it is exact in the exact reading
for any number of vertices.
"""

from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.kernel import Fold, Vec2, fold, kernel

OUTSIDE, BOUNDARY, INSIDE = -1, 0, 1


class Seen(NamedTuple):
    """The state of a pass over the edges: on an edge? an odd number of ray crossings?"""

    on: bool
    odd: bool


@kernel(implements="geofence.swept_by_triangle")
def orient(a: Vec2, b: Vec2, c: Vec2) -> float:
    """Twice the signed area of the triangle a, b, c; its sign is the direction of the turn."""
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)


@kernel(implements="geofence.on_segment_at")
def on_segment(p: Vec2, a: Vec2, b: Vec2) -> bool:
    """True iff p is a point of the closed segment from a to b."""
    if orient(a, b, p) != 0:
        return False
    # no rounding here: if this returns False, no filter is needed
    within_x = min(a.x, b.x) <= p.x and p.x <= max(a.x, b.x)
    return within_x and min(a.y, b.y) <= p.y and p.y <= max(a.y, b.y)


@kernel(implements="geofence.crosses_ray")
def crosses_ray(p: Vec2, a: Vec2, b: Vec2) -> bool:
    """True iff the edge a-b, without its upper end, meets the open ray from p towards +x."""
    a_below = a.y <= p.y
    b_below = b.y <= p.y
    if a_below == b_below:
        return False
    if a_below:
        return orient(a, b, p) > 0
    return orient(a, b, p) < 0


@kernel(supports="locate")
def location_step(seen: Seen, a: Vec2, b: Vec2, p: Vec2) -> Seen:
    """Add the edge a-b to the state of the pass for p."""
    return Seen(seen.on or on_segment(p, a, b), seen.odd != crosses_ray(p, a, b))


@kernel(supports="locate")
def location_result(seen: Seen) -> int:
    """BOUNDARY (0) if on an edge, else INSIDE (1) for an odd number of crossings, else -1."""
    if seen.on:
        return 0
    if seen.odd:
        return 1
    return -1


locate = fold(
    name="locate",
    implements="geofence.location",
    step=location_step,
    start=Seen(False, False),
    finish=location_result,
)


@kernel(implements="geofence.common_point")
def segments_meet(p: Vec2, q: Vec2, a: Vec2, b: Vec2) -> bool:
    """True iff the closed segments p-q and a-b have a point in common."""
    if min(p.x, q.x) > max(a.x, b.x) or min(a.x, b.x) > max(p.x, q.x):
        return False
    if min(p.y, q.y) > max(a.y, b.y) or min(a.y, b.y) > max(p.y, q.y):
        return False
    return straddles(orient(a, b, p), orient(a, b, q)) and straddles(
        orient(p, q, a), orient(p, q, b)
    )


@kernel(supports="segments_meet")
def straddles(one: float, other: float) -> bool:
    """True iff the two are not strictly on the same side of zero."""
    return (one <= 0 or other <= 0) and (one >= 0 or other >= 0)


@kernel(supports="meets_boundary")
def contact_step(met: bool, a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> bool:
    """Whether the leg p-q has met the boundary, with one more edge a-b."""
    return met or segments_meet(p, q, a, b)


meets_boundary = fold(
    name="meets_boundary", implements="geofence.any_step", step=contact_step, start=False
)


@kernel(implements="geofence.enters_keep_out_at")
def keep_out_leg_ok(
    where: int, meets: bool, low_m: float, high_m: float, floor_m: float, ceiling_m: float
) -> bool:
    """True iff a leg avoids a keep-out, boundary included.

    where: location of the leg's first point; meets: whether the leg meets the boundary;
    low_m, high_m: its lowest and highest altitude; floor_m, ceiling_m: the zone's. MSL [m].
    """
    if high_m < floor_m or low_m > ceiling_m:
        return True
    return where < 0 and not meets


@kernel(implements="geofence.leaves_keep_in_at")
def keep_in_leg_ok(
    where: int, meets: bool, low_m: float, high_m: float, floor_m: float, ceiling_m: float
) -> bool:
    """True iff a leg stays strictly inside a keep-in, between its floor and ceiling."""
    return where > 0 and not meets and low_m > floor_m and high_m < ceiling_m


@kernel(implements="geofence.share_a_point")
def edges_clash(after: int, a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool:
    """True iff the edges a-b and c-d have a point in common that edges of a simple chain must not.

    after: 1 if c-d follows on a-b (c is b), -1 if a-b follows on c-d (a is d), else 0. Neighbours
    may share that vertex and nothing else.
    """
    if after > 0:
        return on_segment(d, a, b) or on_segment(a, c, d)
    if after < 0:
        return on_segment(b, c, d) or on_segment(c, a, b)
    return segments_meet(a, b, c, d)


@kernel(supports="twice_area")
def area_step(twice: float, a: Vec2, b: Vec2, p: Vec2) -> float:
    """Add the triangle of p and the edge a-b to twice the signed area so far."""
    return twice + orient(p, a, b)


twice_area: Fold[float] = fold(
    name="twice_area", implements="geofence.swept", step=area_step, start=0
)


def edges_of(vertices: Sequence[tuple[float, float]]) -> tuple[tuple[Vec2, Vec2], ...]:
    """The closed polygon's edges, from its vertices in order."""
    points = [Vec2(*vertex) for vertex in vertices]
    return tuple(zip(points, points[1:] + points[:1], strict=True))
