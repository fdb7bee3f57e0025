"""How often a road crosses the circle about a place. Definition: `spec.cordon`."""

from cratous.core.geofence.distance import apart_squared, edge_against
from cratous.core.kernel import Vec2, kernel


@kernel(implements="cordon.leads_across_at", nonnegative=("radius_m",))
def crossings(middle: Vec2, a: Vec2, b: Vec2, radius_m: float) -> int:
    """How often the straight road a-b crosses the circle: 0, 1 or 2 times. Touching it does not count.

    radius_m: of the circle [m], >= 0. An end on the circle counts as inside, so that of two roads that meet there the
    one that leads outwards crosses it.
    """
    reach = radius_m * radius_m
    starts_inside = apart_squared(middle, a) <= reach
    ends_inside = apart_squared(middle, b) <= reach
    if starts_inside and ends_inside:
        return 0
    if starts_inside or ends_inside:
        return 1
    if edge_against(middle, a, b, radius_m) < 0:
        return 2
    return 0
