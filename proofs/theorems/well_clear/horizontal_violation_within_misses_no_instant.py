"""If the kernel says that the horizontal volume stays clear during [0, h] of straight flight, then
at no instant of [0, h] is it violated, for every relative state and all thresholds not below
zero."""

from cratous.core.well_clear import horizontal_violation_within
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_in_the_plane
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, dthr, tthr = any_in_the_plane(c)
    h, t = c.reals("h t")
    c.premise(t >= 0)
    c.premise(t <= h)
    predicted = c.use(horizontal_violation_within, s, v, dthr, tthr, h)
    violated = c.define(well_clear.horizontal_violation_at, s, v, dthr, tthr, t)
    c.show(c.implies(violated, predicted))
