"""A point that is on a segment for the kernel is the point a + t (b - a) for a t in [0, 1] that can
be named, also when the segment is a single point."""

from cratous.core.geofence.planar import on_segment
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    t = c.real("t")
    ux, uy = b.x - a.x, b.y - a.y
    uu = ux * ux + uy * uy
    # t is the foot of p on the segment's line; 0 for a segment of one point
    c.premise(uu * t == (p.x - a.x) * ux + (p.y - a.y) * uy)
    c.premise(c.implies(uu == 0, t == 0))
    on = c.use(on_segment, p, a, b)
    c.show(c.implies(on, c.define(geofence.on_segment_at, p, a, b, t)))
