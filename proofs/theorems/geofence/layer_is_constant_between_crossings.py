"""Between two neighbouring parameters at which a leg is at the floor or the ceiling, its place in the
layer does not change."""

from cratous.core.geofence.passages import level
from cratous.core.geofence.regions import layer_place
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p_alt, q_alt, floor, ceiling = c.reals("p_alt q_alt floor ceiling")
    t, u, low, high = c.reals("t u low high")
    c.premise(floor <= ceiling)
    for parameter in (t, u):
        c.premise(low < parameter)
        c.premise(parameter < high)
    for bound in (floor, ceiling):
        at = c.use(level, p_alt, q_alt, bound)
        between = (at.num - low * at.den) * (at.num - high * at.den) < 0
        c.premise(c.implies(at.den != 0, c.negation(between)))
    here, there = (c.define(geofence.altitude, p_alt, q_alt, s) for s in (t, u))
    places = [c.use(layer_place, alt, floor, ceiling) for alt in (here, there)]
    c.show(c.same(*places), "the same place")
