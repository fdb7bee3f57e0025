"""If a leg meets an edge, the edge is no farther from the leg's first point than its second point is,
and nearer than every buffer greater than that."""

from cratous.core.geofence.distance import edge_against
from cratous.core.geofence.planar import on_segment, segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import crossing_named, feet_named
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, m, a, b = c.vector("p"), c.vector("m"), c.vector("a"), c.vector("b")
    d = c.real("d")
    s, t, f, g, i, j, k, o, r = c.reals("s t f g i j k o r")
    c.premise(d >= 0)
    c.opaque(segments_meet, on_segment, edge_against)
    c.opaque(geofence.nearer_at, geofence.within_at, geofence.squared_distance)
    crossing_named(c, p, m, a, b, s, t)
    feet_named(c, p, m, a, b, f, g)
    c.lemma("geofence_contact_is_at_a_point_of_the_leg", p=p, q=m, a=a, b=b, s=s, t=t, f=f, g=g)
    squared = c.define(geofence.squared_distance, p, m)
    names = (i, j, k, o, r)
    for v, w in zip((s - s, s - s + 1, s, f, g), names, strict=True):
        # the contact's parameter on the edge, 0 where the edge is a point
        at = Vec2(*c.define(geofence.along, p, m, v))
        ux, uy = b.x - a.x, b.y - a.y
        c.premise((ux * ux + uy * uy) * w == (at.x - a.x) * ux + (at.y - a.y) * uy)
        c.premise(c.implies(ux * ux + uy * uy == 0, w == 0))
        c.lemma("geofence_on_segment_has_a_witness", p=at, a=a, b=b, t=w)
        c.lemma("geofence_edge_verdict_misses_no_point", p=p, a=a, b=b, d=d, t=w)
        c.lemma(
            "geofence_a_common_point_is_no_farther_than_the_end",
            p=p,
            m=m,
            a=a,
            b=b,
            d=d,
            v=v,
            w=w,
        )
    meet = c.use(segments_meet, p, m, a, b)
    verdict = c.use(edge_against, p, a, b, d)
    c.show(c.implies(c.all_of(meet, squared <= d * d), verdict <= 0), "no farther")
    c.show(c.implies(c.all_of(meet, squared < d * d), verdict < 0), "nearer")
