"""A vector is no longer than a number exactly when its square is not greater than the number's."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    p, most = c.vector("p"), c.real("most")
    zero = Vec2(most - most, most - most)
    less = c.use(apart_squared, zero, p) <= most * most
    c.show(c.same(c.define(well_clear.within, p, most), less))
