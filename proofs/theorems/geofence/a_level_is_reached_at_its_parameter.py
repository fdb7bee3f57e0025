"""A leg is at an altitude at just those parameters whose product with the denominator is the numerator; where it is level, at
all of them or at none."""

from cratous.core.geofence.passages import level
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p_alt, q_alt, alt, t = c.reals("p_alt q_alt alt t")
    at = c.use(level, p_alt, q_alt, alt)
    reached = c.define(geofence.altitude, p_alt, q_alt, t) == alt
    c.show(c.same(reached, at.num == t * at.den), "a level is reached at its parameter")
