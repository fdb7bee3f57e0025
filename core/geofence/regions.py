"""Places in regions: layers, intersections, complements, unions, buffers. No division.

Definitions: `spec.geofence`. A place is 1 (in the open part), 0 (on the boundary) or -1 (outside
of the closed part), so an intersection is the least place, a union the greatest, a complement the
negative. A polygon with holes is the intersection of its outline with the complements of the
holes; between floor and ceiling it is the intersection with their layer.
"""

from __future__ import annotations

from cratous.core.kernel import fold, kernel


@kernel(implements="geofence.in_open_layer")
def layer_place(alt_m: float, floor_m: float, ceiling_m: float) -> int:
    """The place of an altitude in the layer from floor to ceiling; all MSL [m]."""
    if alt_m < floor_m or alt_m > ceiling_m:
        return -1
    if alt_m > floor_m and alt_m < ceiling_m:
        return 1
    return 0


@kernel(implements="geofence.intersection")
def both_places(one: int, other: int) -> int:
    """The place in the intersection, from those in two regions."""
    return min(one, other)


@kernel(implements="geofence.union")
def either_place(one: int, other: int) -> int:
    """The place in the union, from those in two regions."""
    return max(one, other)


@kernel(implements="geofence.complement")
def outside_place(place: int) -> int:
    """The place in the complement."""
    return -place


@kernel(implements="geofence.widened")
def widened_place(place: int, against: int) -> int:
    """The place in a region widened by a buffer.

    place: in the region; against: -1, 0, 1 as its boundary is nearer than the buffer, at it, or farther.
    """
    return max(place, -against)


@kernel(implements="geofence.narrowed")
def narrowed_place(place: int, against: int) -> int:
    """The place in a region narrowed by a buffer; the arguments are those of `widened_place`."""
    return min(place, against)


@kernel(implements="geofence.intersection_step")
def everywhere_step(least: int, place: int) -> int:
    """Add a region to an intersection."""
    return both_places(least, place)


@kernel(implements="geofence.union_step")
def anywhere_step(greatest: int, place: int) -> int:
    """Add a region to a union."""
    return either_place(greatest, place)


place_in_all = fold(
    name="place_in_all", implements="geofence.intersection_step", step=everywhere_step, start=1
)

place_in_any = fold(
    name="place_in_any", implements="geofence.union_step", step=anywhere_step, start=-1
)
