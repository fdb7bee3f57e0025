"""If the kernel says that two closed segments meet, they have a point in common that can be named:
the crossing of their lines or, where these are parallel, an end of one segment that lies on the
other."""

from cratous.core.geofence.planar import on_segment, segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    wx, wy, ux, uy = q.x - p.x, q.y - p.y, b.x - a.x, b.y - a.y
    k = wx * uy - wy * ux
    parallel = k == 0
    # the parameters of the lines' crossing, by Cramer's rule
    s, t = c.reals("s t")
    on_w = k * s == (a.x - p.x) * uy - (a.y - p.y) * ux
    on_u = k * t == (a.x - p.x) * wy - (a.y - p.y) * wx
    c.premise(c.implies(c.negation(parallel), c.all_of(on_w, on_u)))
    meet = c.use(segments_meet, p, q, a, b)
    crossing = c.define(geofence.common_point, p, q, a, b, s, t)
    c.show(c.implies(c.all_of(meet, c.negation(parallel)), crossing), "the crossing")
    ends = c.any_of(
        c.use(on_segment, p, a, b),
        c.use(on_segment, q, a, b),
        c.use(on_segment, a, p, q),
        c.use(on_segment, b, p, q),
    )
    c.show(c.implies(c.all_of(meet, parallel), ends), "an end of one on the other")
