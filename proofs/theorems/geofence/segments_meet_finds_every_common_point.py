"""Two closed segments that have a point in common, at whatever parameter on each, meet for the
kernel."""

from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    s, t = c.reals("s t")
    c.opaque(segments_meet)
    common = c.define(geofence.common_point, p, q, a, b, s, t)
    # the common point and the segments' directions, as the lemma wants them
    w, u = Vec2(q.x - p.x, q.y - p.y), Vec2(b.x - a.x, b.y - a.y)
    m = Vec2(p.x + s * w.x, p.y + s * w.y)
    c.lemma("geofence_segments_meet_misses_no_contact", when=common, m=m, w=w, u=u, s=s, t=t)
    ends = Vec2(m.x - t * u.x, m.y - t * u.y), Vec2(m.x + (1 - t) * u.x, m.y + (1 - t) * u.y)
    c.congruence(segments_meet, (p, q, *ends), (p, q, a, b))
    c.show(c.implies(common, c.use(segments_meet, p, q, a, b)))
