"""At every instant of [B, T] of straight flight well clear by taumod is lost exactly if the instant
lies in the span that the kernel gives: for every relative state in space, in any frame, and all
thresholds not below zero, vertically by TCOA or VMOD."""

from cratous.core.well_clear import (
    horizontal_interval_taumod,
    vertical_interval,
    violation_interval_taumod,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, t = c.reals("begin end t")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    c.opaque(
        horizontal_interval_taumod,
        vertical_interval,
        well_clear.horizontal_violation_at,
        well_clear.layer_violation_at,
    )
    span = c.use(violation_interval_taumod, s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, begin, end)
    up = {"sz": sz, "vz": vz, "zthr": zthr, "tcoa": tcoa, "vmod": vmod}
    c.lemma("well_clear_vertical_interval_is_exact", begin=begin, end=end, t=t, **up)
    first, last = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    flat = {"s": s, "v": v, "dthr": dthr, "tthr": tthr, "begin": first, "end": last}
    inside = c.define(well_clear.in_span, first, last, t)
    c.lemma("well_clear_horizontal_interval_taumod_is_exact", when=inside, t=t, **flat)
    c.lemma("well_clear_horizontal_interval_taumod_lies_within", **flat)
    arguments = (s, v, sz, vz, dthr, zthr, tthr, tcoa, vmod, t)
    lost = c.define(well_clear.violation_taumod_at, *arguments)
    c.show(c.same(lost, c.define(well_clear.in_span, *span, t)))
