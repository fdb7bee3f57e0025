"""A leg that meets an edge does so at one of its points that can be named: an end, the crossing of the
lines, or where these are parallel the foot of an end of the edge."""

from cratous.core.geofence.planar import on_segment, segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import crossing_named, feet_named
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    # the parameters on the leg of the crossing and of the feet, and on the edge of the crossing
    s, t, f, g = c.reals("s t f g")
    crossing_named(c, p, q, a, b, s, t)
    feet_named(c, p, q, a, b, f, g)
    c.opaque(on_segment, segments_meet)
    c.lemma("geofence_segments_meet_has_a_witness", p=p, q=q, a=a, b=b, s=s, t=t)
    meet = c.use(segments_meet, p, q, a, b)
    places = []
    for v in (s - s, s - s + 1, s, f, g):
        m = Vec2(*c.define(geofence.along, p, q, v))
        inside = c.all_of(v >= 0, v <= 1)
        places.append(c.all_of(inside, c.use(on_segment, m, a, b)))
    at = Vec2(*c.define(geofence.along, p, q, s))
    c.lemma("geofence_on_segment_misses_no_point", p=at, a=a, b=b, t=t)
    for v, end, w in ((f, a, s - s), (g, b, s - s + 1)):
        c.lemma("geofence_on_segment_has_a_witness", p=end, a=p, b=q, t=v)
        m = Vec2(*c.define(geofence.along, p, q, v))
        c.lemma("geofence_on_segment_misses_no_point", p=m, a=a, b=b, t=w)
    c.show(c.implies(meet, c.any_of(*places)))
