"""The vertical volume is monotone: a greater ZTHR, TCOA or VMOD never makes a violation vanish."""

from cratous.core.well_clear import layer_violation
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz = c.reals("sz vz")
    zthr, tcoa, vmod, zthr2, tcoa2, vmod2 = c.reals("zthr tcoa vmod zthr2 tcoa2 vmod2")
    for low, high in ((zthr, zthr2), (tcoa, tcoa2), (vmod, vmod2)):
        c.premise(low >= 0)
        c.premise(low <= high)
    before = c.use(layer_violation, sz, vz, zthr, tcoa, vmod)
    after = c.use(layer_violation, sz, vz, zthr2, tcoa2, vmod2)
    c.show(c.implies(before, after))
