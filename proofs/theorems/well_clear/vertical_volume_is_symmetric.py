"""The vertical volume is symmetric, by TCOA and by VMOD, now and over [B, T]: the intruder's verdict
and instants are the ownship's."""

from cratous.core.well_clear import layer_violation, vertical_interval, vertical_violation_vmod
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, begin, end = c.reals("sz vz zthr tcoa vmod begin end")
    for threshold in (zthr, tcoa, vmod):
        c.premise(threshold >= 0)
    ours = c.use(layer_violation, sz, vz, zthr, tcoa, vmod)
    c.show(c.same(ours, c.use(layer_violation, 0 - sz, 0 - vz, zthr, tcoa, vmod)), "either")
    ours = c.use(vertical_violation_vmod, sz, vz, zthr, vmod)
    c.show(c.same(ours, c.use(vertical_violation_vmod, 0 - sz, 0 - vz, zthr, vmod)), "by VMOD")
    span = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    back = c.use(vertical_interval, 0 - sz, 0 - vz, zthr, tcoa, vmod, begin, end)
    c.show(c.same(span, back), "over [B, T]")
