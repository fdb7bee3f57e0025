"""Wherever two aircraft are apart and converge, or do not move against each other, some relative velocity
repels to the side that they choose: the criterion is never empty there. It is empty where they part
exactly along the line between them."""

from cratous.core.daa.coordination import horizontal_side, repels
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v, w = c.vector("s"), c.vector("v"), c.vector("w")
    sv, cross = s.x * v.x + s.y * v.y, s.x * v.y - s.y * v.x
    c.premise(c.negation(c.all_of(s.x == 0, s.y == 0)))
    side = c.use(horizontal_side, s, v)
    right = side > 0
    across = Vec2(c.when(right, s.y, 0 - s.y), c.when(right, 0 - s.x, s.x))
    still = c.all_of(v.x == 0, v.y == 0)
    there = c.use(repels, s, v, across, side)
    c.show(c.implies(c.any_of(sv < 0, still), there), "there is one")
    parting = c.all_of(sv > 0, cross == 0)
    c.show(c.implies(parting, c.negation(c.use(repels, s, v, w, side))), "there is none")
