"""An edge that is met by a part of a leg, from its first point to any other of its points, is met by
the whole leg."""

from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    t = c.real("t")
    c.premise(t >= 0)
    c.premise(t <= 1)
    m = Vec2(p.x + t * (q.x - p.x), p.y + t * (q.y - p.y))
    part = c.use(segments_meet, p, m, a, b)
    c.show(c.implies(part, c.use(segments_meet, p, q, a, b)))
