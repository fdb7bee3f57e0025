"""Whether a small square lies in a convex polygon: left of all its edges; and whether enough was seen.

Definitions: `spec.geofence`.
"""

from cratous.core.geofence.planar import orient
from cratous.core.kernel import Vec2, fold, kernel


@kernel(implements="geofence.square_point_left_of")
def square_left_of(a: Vec2, b: Vec2, centre: Vec2, half: float) -> bool:
    """True iff every point of the square lies left of the line a-b, or on it.

    centre, half: the square's centre and half of its side [m], >= 0; sides along the axes.
    """
    return orient(a, b, centre) >= half * (abs(b.x - a.x) + abs(b.y - a.y))


@kernel(implements="geofence.every_step")
def within_step(so_far: bool, a: Vec2, b: Vec2, centre: Vec2, half: float) -> bool:
    """Add the edge a-b to whether the square is left of all edges."""
    return so_far and square_left_of(a, b, centre, half)


square_within = fold(
    name="square_within", implements="geofence.every_step", step=within_step, start=True
)


@kernel(implements="geofence.part_seen")
def enough_seen(unseen: float, whole: float) -> bool:
    """True iff a search of this size is served: at most one part in a hundred of it was not seen.

    unseen, whole: in one unit, points of a line or square metres of an area, >= 0.
    """
    return 100 * unseen <= whole
