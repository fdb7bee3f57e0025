"""A leg that the keep-in kernel accepts begins strictly inside the polygon, never meets its boundary,
and is strictly between floor and ceiling at each altitude that it has; and it refuses no other."""

from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    where, meets = c.integer("where"), c.boolean("meets")
    low, high, floor, ceiling, alt = c.reals("low high floor ceiling alt")
    for smaller, larger in ((low, high), (floor, ceiling), (low, alt), (alt, high)):
        c.premise(smaller <= larger)
    c.premise(c.any_of(where == -1, where == 0, where == 1))
    accepted = c.use(keep_in_leg_ok, where, meets, low, high, floor, ceiling)
    clear = c.all_of(where == 1, c.negation(meets))
    in_layer = c.define(geofence.altitude_in_keep_in, alt, floor, ceiling)
    c.show(c.implies(accepted, c.all_of(clear, in_layer)), "accepted legs are inside")
    ends = c.all_of(
        c.define(geofence.altitude_in_keep_in, low, floor, ceiling),
        c.define(geofence.altitude_in_keep_in, high, floor, ceiling),
    )
    c.show(c.implies(c.all_of(clear, ends), accepted), "no other leg is refused")
    at = [
        c.define(geofence.leaves_keep_in_at, where, meets, z, floor, ceiling)
        for z in (alt, low, high)
    ]
    c.show(c.implies(accepted, c.negation(at[0])), "it leaves at no altitude")
    c.show(c.implies(c.negation(accepted), c.any_of(at[1], at[2])), "or at one of its ends")
