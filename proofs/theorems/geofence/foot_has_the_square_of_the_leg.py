"""The feet of any two points on a leg have one denominator, the square of the leg's length, which is
positive where the leg has a length."""

from cratous.core.geofence.passages import foot
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    first, second = c.use(foot, p, q, a), c.use(foot, p, q, b)
    squared = c.define(geofence.squared_distance, p, q)
    c.show(c.all_of(c.same(first.den, squared), c.same(second.den, squared)), "the square")
    c.show(c.implies(c.any_of(p.x != q.x, p.y != q.y), first.den > 0), "positive")
    c.show(first.den >= 0, "not negative")
