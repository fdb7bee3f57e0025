"""Plain tau is the known bad example: there are states at which its horizontal volume is violated,
clear a while later, and violated again in the same straight flight. One of them: 600 m ahead and
140 m aside, closing at 20 m/s, with DTHR 150 m and TTHR 16 s, is violated after 20 s, clear after
27 s, violated after 28 s."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation_tau
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    for value, known in ((s.x, 600), (s.y, 140), (v.x, -20), (v.y, 0), (dthr, 150), (tthr, 16)):
        c.premise(value == known)
    for t, violated in ((20, True), (27, False), (28, True)):
        there = Vec2(s.x + t * v.x, s.y + t * v.y)
        c.show(c.same(c.use(horizontal_violation_tau, there, v, dthr, tthr), violated), f"{t} s")
