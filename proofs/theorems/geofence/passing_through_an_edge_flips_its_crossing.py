"""If a leg passes through an edge, from strictly one side to strictly the other and between the
edge's ends, then the ray crossings of that edge from the leg's two ends differ exactly if the strip
between the two rays holds both ends of the edge or neither: the opposite of an edge that is missed."""

from cratous.core.geofence.planar import crosses_ray, orient
from cratous.proofs.claim import Claim
from cratous.proofs.methods.sweeping import swept


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    sides = c.use(orient, a, b, p) * c.use(orient, a, b, q) < 0
    ends = c.use(orient, p, q, a) * c.use(orient, p, q, b) < 0
    from_p, from_q = c.use(crosses_ray, p, a, b), c.use(crosses_ray, q, a, b)
    at_a, at_b = c.define(swept, a, p, q), c.define(swept, b, p, q)
    differ = c.negation(c.same(from_p, from_q))
    c.show(c.implies(c.all_of(sides, ends), c.same(differ, c.same(at_a, at_b))))
