"""If any point of an edge is nearer to a point than the buffer, or just so near, the kernel says so,
for every edge, also one of length zero."""

from cratous.core.geofence.distance import edge_against, edge_distance
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    d, t = c.reals("d t")
    c.opaque(edge_distance)
    inside = c.all_of(t >= 0, t <= 1)
    c.lemma("geofence_edge_distance_is_the_least", when=inside, p=p, a=a, b=b, t=t)
    verdict = c.use(edge_against, p, a, b, d)
    nearer = c.define(geofence.nearer_at, p, a, b, d, t)
    within = c.define(geofence.within_at, p, a, b, d, t)
    c.show(c.implies(nearer, verdict < 0), "nearer")
    c.show(c.implies(within, verdict <= 0), "no farther")
