"""The square of the sum of two vectors is bounded by bounds on both squares and on the scalar product."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, o = c.vector("p"), c.vector("o")
    first, second, third = c.reals("first second third")
    zero = Vec2(first - first, first - first)
    pp, oo = c.use(apart_squared, zero, p), c.use(apart_squared, zero, o)
    c.premise(pp <= first)
    c.premise(oo <= third)
    c.premise(p.x * o.x + p.y * o.y <= second)
    c.show(c.use(apart_squared, zero, Vec2(p.x + o.x, p.y + o.y)) <= first + 2 * second + third)
