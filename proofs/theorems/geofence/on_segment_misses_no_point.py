"""Every point of a closed segment is on it for the kernel, ends included, for every segment."""

from cratous.core.geofence.planar import on_segment
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    t = c.real("t")
    on = c.use(on_segment, p, a, b)
    c.show(c.implies(c.define(geofence.on_segment_at, p, a, b, t), on))
