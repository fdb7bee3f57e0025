"""If two neighbouring edges of a chain, each between two different vertices, have a point in common
beside the vertex that they share, the kernel says that they clash; so it does for edges apart
that have any point in common."""

from cratous.core.geofence.planar import edges_clash, segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, d, e = c.vector("a"), c.vector("b"), c.vector("c"), c.vector("d")
    s, t = c.reals("s t")
    c.premise(c.any_of(a.x != b.x, a.y != b.y))
    c.premise(c.any_of(b.x != e.x, b.y != e.y))
    shared = c.define(geofence.share_a_point, a, b, b, e, s, t, True)
    c.show(c.implies(shared, c.use(edges_clash, 1, a, b, b, e)), "neighbours")
    c.opaque(segments_meet)
    c.lemma("geofence_segments_meet_finds_every_common_point", p=a, q=b, a=d, b=e, s=s, t=t)
    common = c.define(geofence.share_a_point, a, b, d, e, s, t, False)
    c.show(c.implies(common, c.use(edges_clash, 0, a, b, d, e)), "apart")
    c.show(c.same(common, c.define(geofence.common_point, a, b, d, e, s, t)), "apart: any point")
