"""When a road crosses a circle.

Source: the cordon task of IMPACT, whose standoff distance is the radius about its location; what its message leaves
open is defined here. Metres.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, along, squared_distance


def leads_across_at(
    middle: Point, a: Point, b: Point, radius: float, inner: float, outer: float
) -> bool:
    """The straight road a-b is inside the circle at the parameter `inner` and outside it at `outer`.

    The direction and number of crossings do not matter.
    """
    on_it = inner >= 0 and inner <= 1 and outer >= 0 and outer <= 1
    near = squared_distance(middle, along(a, b, inner))
    far = squared_distance(middle, along(a, b, outer))
    return on_it and near < radius * radius and far > radius * radius
