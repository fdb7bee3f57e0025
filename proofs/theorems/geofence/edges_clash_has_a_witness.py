"""If the kernel says that two edges clash, they have a point in common that two edges of a simple
polygon must not have: any at all, or for neighbours one beside the vertex that they share."""

from cratous.core.geofence.planar import edges_clash, on_segment, segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, d, e = c.vector("a"), c.vector("b"), c.vector("c"), c.vector("d")
    c.premise(c.any_of(a.x != b.x, a.y != b.y))
    c.premise(c.any_of(d.x != e.x, d.y != e.y))
    # edges apart: the very kernel that finds every common point
    c.show(c.same(c.use(edges_clash, 0, a, b, d, e), c.use(segments_meet, a, b, d, e)), "apart")
    # neighbours a-b and b-e: e on a-b at s, or a on b-e at t
    s, t = c.reals("s t")
    ux, uy, wx, wy = b.x - a.x, b.y - a.y, e.x - b.x, e.y - b.y
    c.premise((ux * ux + uy * uy) * s == (e.x - a.x) * ux + (e.y - a.y) * uy)
    c.premise((wx * wx + wy * wy) * t == (a.x - b.x) * wx + (a.y - b.y) * wy)
    c.premise(c.any_of(b.x != e.x, b.y != e.y))
    clash = c.use(edges_clash, 1, a, b, b, e)
    one = s - s + 1
    first = c.define(geofence.share_a_point, a, b, b, e, s, one, True)
    second = c.define(geofence.share_a_point, a, b, b, e, s - s, t, True)
    c.show(c.implies(clash, c.any_of(first, second)), "neighbours")
    turned = c.use(edges_clash, -1, b, e, a, b)
    c.opaque(on_segment)
    c.show(c.same(clash, turned), "neighbours, the other way round")
