"""Two edges that both lie through one place, wherever on each of them it is, have a point in common that edges apart of
a simple polygon must not have, and the kernel says that they clash."""

from cratous.core.geofence.planar import edges_clash, segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    m, u, w = c.vector("m"), c.vector("u"), c.vector("w")
    s, t = c.reals("s t")
    c.premise(c.any_of(u.x != 0, u.y != 0))
    c.premise(c.any_of(w.x != 0, w.y != 0))
    a, b = Vec2(m.x - s * u.x, m.y - s * u.y), Vec2(m.x - s * u.x + u.x, m.y - s * u.y + u.y)
    d, e = Vec2(m.x - t * w.x, m.y - t * w.y), Vec2(m.x - t * w.x + w.x, m.y - t * w.y + w.y)
    common = c.define(geofence.share_a_point, a, b, d, e, s, t, False)
    on_both = c.all_of(s >= 0, s <= 1, t >= 0, t <= 1)
    c.show(c.same(common, on_both), "the place is on both")
    c.opaque(segments_meet)
    c.lemma("geofence_segments_meet_finds_every_common_point", p=a, q=b, a=d, b=e, s=s, t=t)
    c.show(c.implies(common, c.use(edges_clash, 0, a, b, d, e)), "they clash")
