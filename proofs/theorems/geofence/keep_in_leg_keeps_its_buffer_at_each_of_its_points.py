"""A leg that is accepted for a keep-in with a buffer is strictly inside of the zone narrowed by the
buffer, and of its layer, at each of its points, for every polygon and whatever its number of vertices."""

from typing import Any

from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.core.geofence.regions import narrowed_place
from cratous.proofs.claim import Claim
from cratous.proofs.methods.legs import leg_keeps_its_buffer
from cratous.spec import geofence


def claim(c: Claim) -> None:
    def inside(place: Any) -> Any:
        return c.define(geofence.in_open, place)

    leg_keeps_its_buffer(c, keep_in_leg_ok, narrowed_place, inside)
