"""No point of an edge has a smaller squared distance than the kernel gives for the edge, whose
denominator is positive."""

from cratous.core.geofence.distance import edge_distance
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b, t = c.vector("p"), c.vector("a"), c.vector("b"), c.real("t")
    c.premise(t >= 0)
    c.premise(t <= 1)
    found = c.use(edge_distance, p, a, b)
    there = c.define(geofence.along, a, b, t)
    c.show(found.den > 0, "a positive denominator")
    c.show(found.num <= c.define(geofence.squared_distance, p, there) * found.den, "the least")
