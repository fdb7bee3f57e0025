"""The scalar product of two vectors is no greater than the product of two numbers that their lengths do not
exceed: Cauchy and Schwarz."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, o = c.vector("p"), c.vector("o")
    a, b = c.reals("a b")
    zero = Vec2(a - a, a - a)
    c.premise(c.all_of(a >= 0, b >= 0))
    pp, oo = c.use(apart_squared, zero, p), c.use(apart_squared, zero, o)
    c.premise(pp <= a * a)
    c.premise(oo <= b * b)
    dot, cross = p.x * o.x + p.y * o.y, p.x * o.y - p.y * o.x
    c.step(dot * dot + cross * cross == pp * oo, "Lagrange's identity")
    c.step(pp * oo <= a * a * b * b, "the product of both squares")
    c.step(dot * dot <= (a * b) * (a * b), "without the other square")
    c.step(a * b >= 0, "of one sign")
    c.show(dot <= a * b)
