"""An edge that turns back and ends on the edge before it, wherever on that one but at the vertex that they share, has a
point in common with it that neighbours of a simple polygon must not have, and the kernel says that they clash."""

from cratous.core.geofence.planar import edges_clash
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, s = c.vector("a"), c.vector("b"), c.real("s")
    c.premise(c.any_of(a.x != b.x, a.y != b.y))
    end = Vec2(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y))
    one = s - s + 1
    shared = c.define(geofence.share_a_point, a, b, b, end, s, one, True)
    c.show(c.same(shared, c.all_of(s >= 0, s <= 1)), "it ends on the edge before it")
    c.show(c.implies(shared, c.use(edges_clash, 1, a, b, b, end)), "they clash")
