"""If a leg misses an edge, the ray crossings of that edge from the leg's two ends differ exactly if
the strip between the two rays holds one end of the edge and not the other."""

from cratous.core.geofence.planar import crosses_ray, segments_meet
from cratous.proofs.claim import Claim
from cratous.proofs.methods.sweeping import swept


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    missed = c.negation(c.use(segments_meet, p, q, a, b))
    from_p, from_q = c.use(crosses_ray, p, a, b), c.use(crosses_ray, q, a, b)
    at_a, at_b = c.define(swept, a, p, q), c.define(swept, b, p, q)
    c.show(c.implies(missed, c.same(c.same(from_p, from_q), c.same(at_a, at_b))))
