"""At every instant of [B, T] the vertical volume, by TCOA or VMOD, is violated exactly if the instant
lies in the span that the interval kernel gives."""

from cratous.core.well_clear import vertical_interval
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, begin, end, t = c.reals("sz vz zthr tcoa vmod begin end t")
    for threshold in (zthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    span = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    violated = c.define(well_clear.layer_violation_at, sz, vz, zthr, tcoa, vmod, t)
    c.show(c.same(violated, c.define(well_clear.in_span, *span, t)))
