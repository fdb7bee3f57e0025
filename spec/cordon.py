"""What is meant by a road that leads across a circle.

Source: the cordon task of IMPACT, whose standoff distance is the radius about its place; what its message leaves
open is settled here. Metres.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, along, squared_distance


def leads_across_at(
    middle: Point, a: Point, b: Point, radius: float, inner: float, outer: float
) -> bool:
    """The straight road a-b is inside of the circle at the parameter `inner` and outside of it at `outer`.

    Whether it leads out or in, and how often, is one: nobody comes across the circle on any other road.
    """
    on_it = inner >= 0 and inner <= 1 and outer >= 0 and outer <= 1
    near = squared_distance(middle, along(a, b, inner))
    far = squared_distance(middle, along(a, b, outer))
    return on_it and near < radius * radius and far > radius * radius
