"""Whatever lies straight between two vectors is no longer than a number that neither of them is longer than. In squares."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    a, b = c.vector("a"), c.vector("b")
    most, s = c.reals("most s")
    zero = Vec2(s - s, s - s)
    aa, bb = c.use(apart_squared, zero, a), c.use(apart_squared, zero, b)
    gap = c.use(apart_squared, a, b)
    c.premise(c.all_of(s >= 0, s <= 1))
    between = Vec2(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y))
    off = c.use(apart_squared, zero, between)
    c.step(off == (1 - s) * aa + s * bb - s * (1 - s) * gap, "a mean, less what is between them")
    c.step(gap >= 0, "a square")
    c.step(s * (1 - s) >= 0, "both shares")
    c.step(s * (1 - s) * gap >= 0, "what is between them")
    c.step(c.implies(aa <= most, (1 - s) * aa <= (1 - s) * most), "by the one")
    c.step(c.implies(bb <= most, s * bb <= s * most), "by the other")
    c.show(c.implies(c.all_of(aa <= most, bb <= most), off <= most))
