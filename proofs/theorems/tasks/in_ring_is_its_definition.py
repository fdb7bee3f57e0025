"""Who is at a place about what moves is neither too near to it nor too far from it, and every such is."""

from cratous.core.tasks.stations import in_ring
from cratous.proofs.claim import Claim
from cratous.spec import stations


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    least, most = c.reals("least most")
    c.premise(least >= 0)
    c.premise(most >= least)
    said = c.use(in_ring, p, q, least, most)
    c.show(c.same(said, c.define(stations.in_ring_at, p, q, least, most)), "its definition")
