"""For every relative altitude and climb rate and all thresholds not below zero, the vertical
kernel says `violated` exactly when the definition with time to co-altitude does."""

from cratous.core.well_clear import vertical_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa = c.reals("sz vz zthr tcoa")
    c.premise(zthr >= 0)
    c.premise(tcoa >= 0)
    verdict = c.use(vertical_violation, sz, vz, zthr, tcoa)
    c.show(c.same(verdict, c.define(well_clear.vertical_violation, sz, vz, zthr, tcoa)))
