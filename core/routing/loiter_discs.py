"""Whether a loiter location obeys the zones: for a whole disc, by the proved polygon kernels.

A disc keeps out of a polygon iff its centre does and no edge is within the radius, and stays inside one iff its
centre does and no edge is within the radius; the same then holds for every circle in the disc, wherever it is
entered.
"""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.geofence.distance import boundary_against
from cratous.core.geofence.planar import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2, driver
from cratous.spec.mission import Position, Zone, ZoneKind


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "boundary_against"))
def disc_ok(centre: Position, radius_m: float, zone: Zone) -> bool:
    """True iff every point of a level disc obeys the zone. ValueError if the zone has padding."""
    if zone.padding_m != 0:
        raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
    edges, at = edges_of(zone.vertices), Vec2(centre.north_m, centre.east_m)
    meets = boundary_against(edges, at, radius_m) <= 0
    holds = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    alt_m = centre.alt_m
    return holds(locate(edges, at), meets, alt_m, alt_m, zone.floor_m, zone.ceiling_m)


def broken_by(centre: Position, radius_m: float, zones: Sequence[Zone]) -> Zone | None:
    """The first zone that a disc does not obey, or None."""
    return next((zone for zone in zones if not disc_ok(centre, radius_m, zone)), None)
