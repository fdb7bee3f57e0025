"""A vector is no longer than a number exactly when the opposite one is; it then is so scaled together with
the number, and no longer than any greater number."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    p = c.vector("p")
    most, more, times = c.reals("most more times")
    c.premise(times >= 0)
    c.premise(c.all_of(most >= 0, more >= most))
    back, scaled = Vec2(0 - p.x, 0 - p.y), Vec2(times * p.x, times * p.y)
    length = c.use(apart_squared, back, Vec2(most - most, most - most))
    within = c.define(well_clear.within, p, most)
    c.show(c.same(within, c.define(well_clear.within, back, most)), "the opposite one")
    square = scaled.x * scaled.x + scaled.y * scaled.y
    c.step(square == times * times * length, "the square of the scaled one")
    c.step(c.implies(within, times * times * length <= times * times * (most * most)), "scaled")
    c.show(c.implies(within, c.define(well_clear.within, scaled, times * most)), "the scaled one")
    c.step(most * most <= more * more, "the greater square")
    c.show(c.implies(within, c.define(well_clear.within, p, more)), "the greater number")
