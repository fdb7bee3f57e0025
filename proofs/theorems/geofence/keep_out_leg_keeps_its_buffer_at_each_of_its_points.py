"""A leg that is accepted for a keep-out with a buffer is outside of the zone widened by the buffer, or of
its layer, at each of its points, for every polygon and whatever its number of vertices."""

from typing import Any

from cratous.core.geofence.planar import keep_out_leg_ok
from cratous.core.geofence.regions import widened_place
from cratous.proofs.claim import Claim
from cratous.proofs.methods.legs import leg_keeps_its_buffer
from cratous.spec import geofence


def claim(c: Claim) -> None:
    def outside(place: Any) -> Any:
        return c.negation(c.define(geofence.in_closed, place))

    leg_keeps_its_buffer(c, keep_out_leg_ok, widened_place, outside)
