"""A point that lies strictly on one side of an edge is no point of the edge."""

from cratous.core.geofence.planar import on_segment, orient
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    sides = c.use(orient, a, b, p) * c.use(orient, a, b, q) < 0
    on = c.any_of(c.use(on_segment, p, a, b), c.use(on_segment, q, a, b))
    c.show(c.implies(sides, c.negation(on)))
