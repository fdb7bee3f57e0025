"""Of two ratios with positive denominators the kernel gives the one that is the lesser number, and any
ratio in place of infinity; of equally near edges the first stands."""

from cratous.core.geofence.distance import Ratio, distance_step, edge_distance, lesser
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    x, y, dx, dy = c.reals("x y dx dy")
    c.premise(dx > 0)
    c.premise(dy > 0)
    one, other = Ratio(x * dx, dx), Ratio(y * dy, dy)
    found = c.use(lesser, one, other)
    c.show(c.same(found.num, c.when(x <= y, x, y) * found.den), "the lesser number")
    c.show(found.den > 0, "a number")
    infinite = c.use(lesser, Ratio(x - x + 1, x - x), other)
    c.show(c.same(infinite, other), "infinity is greater than any")
    c.show(c.implies(x == y, c.same(found, one)), "of two equal ones the first")
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    c.opaque(edge_distance)
    edge = c.use(edge_distance, p, a, b)
    stands = one.num * edge.den == edge.num * one.den
    c.show(c.implies(stands, c.same(c.use(distance_step, one, a, b, p), one)), "the first edge")
