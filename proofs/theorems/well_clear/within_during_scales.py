"""Whether two straight courses come within a distance during a span does not depend on the unit of
length or time: position, distance and span scaled by the same positive factor give the same verdict."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import within_during
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    radius, h, k = c.reals("radius h k")
    for least in (radius, h):
        c.premise(least >= 0)
    c.premise(k > 0)
    scaled = Vec2(k * s.x, k * s.y)
    near = c.use(within_during, s, v, radius, h)
    c.show(c.same(near, c.use(within_during, scaled, v, k * radius, k * h)), "the kernel does not")
    now = c.define(well_clear.within, s, radius)
    c.show(c.same(now, c.define(well_clear.within, scaled, k * radius)), "the definition does not")
