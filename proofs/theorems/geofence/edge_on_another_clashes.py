"""An edge that begins on another one, wherever on it, clashes with it; so does one that follows on it, turns back and
ends on it, wherever on it but at the vertex that they share."""

from cratous.core.geofence.planar import edges_clash
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, e, s = c.vector("a"), c.vector("b"), c.vector("e"), c.real("s")
    c.premise(c.any_of(a.x != b.x, a.y != b.y))
    on = Vec2(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y))
    zero, one = s - s, s - s + 1
    apart = c.define(geofence.share_a_point, a, b, on, e, s, zero, False)
    c.show(c.implies(apart, c.use(edges_clash, 0, a, b, on, e)), "it begins there")
    shared = c.define(geofence.share_a_point, a, b, b, on, s, one, True)
    c.show(c.implies(shared, c.use(edges_clash, 1, a, b, b, on)), "it ends there")
    c.show(c.same(apart, c.all_of(s >= 0, s <= 1)), "the place is on the edge")
    c.show(c.same(shared, apart), "in both cases")
