"""Well clear is symmetric: seen from the intruder, the verdict is the same as seen from the
ownship, for every relative state and all thresholds not below zero."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa


def claim(c: Claim) -> None:
    (s, v, sz, vz), (dthr, zthr, tthr, tcoa) = any_by_tcoa(c)
    ours = c.use(violation, s, v, sz, vz, dthr, zthr, tthr, tcoa)
    back_s, back_v = Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y)
    theirs = c.use(violation, back_s, back_v, 0 - sz, 0 - vz, dthr, zthr, tthr, tcoa)
    c.show(c.same(ours, theirs))
