"""For every relative altitude and climb rate and all thresholds not below zero, the vertical kernel
with VMOD says `violated` exactly when the definition does."""

from cratous.core.well_clear import vertical_violation_vmod
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, vmod = c.reals("sz vz zthr vmod")
    c.premise(zthr >= 0)
    c.premise(vmod >= 0)
    verdict = c.use(vertical_violation_vmod, sz, vz, zthr, vmod)
    c.show(c.same(verdict, c.define(well_clear.vertical_violation_vmod, sz, vz, zthr, vmod)))
