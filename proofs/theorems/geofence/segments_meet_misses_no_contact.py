"""If two closed segments have a point in common, the kernel says that they meet: a leg that touches
a zone's edge anywhere is never taken for a leg that does not."""

from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    # a common point m, the segments' directions w and u, and m's parameter on each: every pair of
    # segments that meet is of this form, and every choice with s and t in [0, 1] gives such a pair
    m, w, u = c.vector("m"), c.vector("w"), c.vector("u")
    s, t = c.reals("s t")
    for parameter in (s, t):
        c.premise(parameter >= 0)
        c.premise(parameter <= 1)
    p, q = Vec2(m.x - s * w.x, m.y - s * w.y), Vec2(m.x + (1 - s) * w.x, m.y + (1 - s) * w.y)
    a, b = Vec2(m.x - t * u.x, m.y - t * u.y), Vec2(m.x + (1 - t) * u.x, m.y + (1 - t) * u.y)
    c.show(c.use(segments_meet, p, q, a, b))
