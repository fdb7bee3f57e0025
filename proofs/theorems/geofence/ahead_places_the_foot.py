"""How far a point is ahead along an edge says where the foot of its perpendicular is: at that share of
the edge's squared length."""

from cratous.core.geofence.distance import ahead, apart_squared
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b, t = c.vector("p"), c.vector("a"), c.vector("b"), c.real("t")
    far, length = c.use(ahead, p, a, b), c.use(apart_squared, a, b)
    c.show(c.same(c.define(geofence.foot_at, p, a, b, t), far == t * length))
