"""The vertical kernel with either lead says `violated` exactly when the volume with TCOA or the one
with VMOD is; with one lead 0 it is the kernel of the other."""

from cratous.core.well_clear import layer_violation, vertical_violation, vertical_violation_vmod
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod = c.reals("sz vz zthr tcoa vmod")
    for threshold in (zthr, tcoa, vmod):
        c.premise(threshold >= 0)
    verdict = c.use(layer_violation, sz, vz, zthr, tcoa, vmod)
    wanted = c.define(well_clear.layer_violation, sz, vz, zthr, tcoa, vmod)
    c.show(c.same(verdict, wanted), "the definition")
    by_tcoa = c.use(vertical_violation, sz, vz, zthr, tcoa)
    by_vmod = c.use(vertical_violation_vmod, sz, vz, zthr, vmod)
    c.show(c.implies(vmod == 0, c.same(verdict, by_tcoa)), "by TCOA alone")
    c.show(c.implies(tcoa == 0, c.same(verdict, by_vmod)), "by VMOD alone")
