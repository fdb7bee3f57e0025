"""A leg that the keep-in kernel accepts is strictly inside the zone, off its boundary, floor and
ceiling, at each of its points, for every polygon and whatever its number of vertices."""

from typing import Any

from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.proofs.claim import Claim
from cratous.proofs.methods.legs import leg_is_clear
from cratous.spec import geofence


def claim(c: Claim) -> None:
    def inside(place: Any) -> Any:
        return c.define(geofence.in_open, place)

    leg_is_clear(c, keep_in_leg_ok, inside)
