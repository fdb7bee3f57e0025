"""If any point of a leg is within a buffer of an edge, so is the leg for the kernel: a leg that it calls
clear is farther than the buffer from the edge at each of its points, and does not meet it."""

from cratous.core.geofence.distance import edge_against, leg_within
from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import share
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d, t = c.reals("d t")
    c.premise(t >= 0)
    c.premise(t <= 1)
    m = Vec2(*c.define(geofence.along, p, q, t))
    ux, uy = b.x - a.x, b.y - a.y
    foot = share(c, (m.x - a.x) * ux + (m.y - a.y) * uy, ux * ux + uy * uy)
    c.opaque(edge_against, leg_within, segments_meet, geofence.squared_distance)
    c.lemma("geofence_edge_verdict_has_a_witness", p=m, a=a, b=b, d=d, t=foot)
    for at in (foot - foot, foot - foot + 1, foot):
        inside = c.all_of(at >= 0, at <= 1)
        c.lemma(
            "geofence_leg_verdict_misses_no_pair", when=inside, p=p, q=q, a=a, b=b, d=d, s=t, t=at
        )
        alone = c.define(geofence.within_at, m, a, b, d, at)
        pair = c.define(geofence.legs_within_at, p, q, a, b, d, t, at)
        c.step(c.implies(alone, pair), "the point is one of the leg")
    near = c.use(edge_against, m, a, b, d) <= 0
    c.show(c.implies(near, c.use(leg_within, p, q, a, b, d)), "a point that is near")
    c.lemma("geofence_leg_verdict_has_a_witness", p=p, q=q, a=a, b=b, d=d)
    c.show(c.implies(c.use(segments_meet, p, q, a, b), c.use(leg_within, p, q, a, b, d)), "contact")
