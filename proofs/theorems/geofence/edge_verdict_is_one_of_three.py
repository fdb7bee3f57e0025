"""The verdict on an edge is -1, 0 or 1: the sign of the difference between its squared distance and
the squared buffer, and nothing else."""

from cratous.core.geofence.distance import edge_against, sign_of
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    d, value = c.reals("d value")
    verdict = c.use(edge_against, p, a, b, d)
    c.show(c.any_of(verdict == -1, verdict == 0, verdict == 1), "one of three")
    c.show(c.same(c.use(sign_of, value), c.define(geofence.sign, value)), "the sign")
