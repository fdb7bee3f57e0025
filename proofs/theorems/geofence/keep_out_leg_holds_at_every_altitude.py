"""A leg that the keep-out kernel accepts is either outside the zone's layer at each altitude between
its lowest and highest, or begins outside the polygon and never meets its boundary; and it refuses
no other leg."""

from cratous.core.geofence.planar import keep_out_leg_ok
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    where, meets = c.integer("where"), c.boolean("meets")
    low, high, floor, ceiling, alt = c.reals("low high floor ceiling alt")
    for smaller, larger in ((low, high), (floor, ceiling), (low, alt), (alt, high)):
        c.premise(smaller <= larger)
    accepted = c.use(keep_out_leg_ok, where, meets, low, high, floor, ceiling)
    inside_layer = c.define(geofence.altitude_in_keep_out, alt, floor, ceiling)
    clear = c.all_of(where == -1, c.negation(meets))
    c.premise(c.any_of(where == -1, where == 0, where == 1))
    c.show(c.implies(c.all_of(accepted, inside_layer), clear), "accepted legs are clear")
    # the leg's altitude nearest to the layer's floor is in the layer whenever any of its is
    nearest = c.when(floor < low, low, c.when(floor > high, high, floor))
    touches = c.define(geofence.altitude_in_keep_out, nearest, floor, ceiling)
    refused = c.negation(accepted)
    c.show(c.implies(refused, c.all_of(touches, c.negation(clear))), "refused legs are not")
    at_any = c.define(geofence.enters_keep_out_at, where, meets, alt, floor, ceiling)
    c.show(c.implies(accepted, c.negation(at_any)), "it enters at no altitude")
    at_it = c.define(geofence.enters_keep_out_at, where, meets, nearest, floor, ceiling)
    c.show(c.implies(refused, at_it), "or at that one")
