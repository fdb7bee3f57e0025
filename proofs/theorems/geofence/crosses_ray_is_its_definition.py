"""The kernel counts an edge exactly when the edge, without its upper end, meets the open ray from
the point towards +x."""

from cratous.core.geofence.planar import crosses_ray
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    crosses = c.use(crosses_ray, p, a, b)
    c.show(c.same(crosses, c.define(geofence.crosses_ray, p, a, b)))
