"""An edge that the kernel calls nearer to a point than the buffer, or just so near, has a point that
is: one of its ends, or the foot of the perpendicular from the point."""

from typing import Any

from cratous.core.geofence.distance import edge_against, edge_distance
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    d, t = c.reals("d t")
    # t is the foot of the perpendicular, where the edge has a length
    c.premise(c.define(geofence.foot_at, p, a, b, t))
    c.opaque(edge_distance, geofence.squared_distance)
    c.lemma("geofence_edge_distance_is_attained", p=p, a=a, b=b, t=t)
    verdict = c.use(edge_against, p, a, b, d)

    def reached(definition: Any) -> object:
        at = [c.define(definition, p, a, b, d, place) for place in (t - t, t - t + 1, t)]
        return c.any_of(*at)

    c.show(c.implies(verdict < 0, reached(geofence.nearer_at)), "nearer")
    c.show(c.implies(verdict <= 0, reached(geofence.within_at)), "no farther")
