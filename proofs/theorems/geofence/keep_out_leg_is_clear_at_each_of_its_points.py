"""A leg that the keep-out kernel accepts is outside of the zone, its boundary, floor and ceiling
included, at each of its points, for every polygon and whatever its number of vertices."""

from typing import Any

from cratous.core.geofence.planar import keep_out_leg_ok
from cratous.proofs.claim import Claim
from cratous.proofs.methods.legs import leg_is_clear
from cratous.spec import geofence


def claim(c: Claim) -> None:
    def outside(place: Any) -> Any:
        return c.negation(c.define(geofence.in_closed, place))

    leg_is_clear(c, keep_out_leg_ok, outside)
