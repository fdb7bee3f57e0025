"""Well clear by tcpa is symmetric: seen from the intruder, the verdict now and the first and last
instant over [B, T] are those that the ownship sees."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import (
    horizontal_interval_tcpa,
    horizontal_violation_tcpa,
    layer_violation,
    vertical_interval,
    violation_interval_tcpa,
    violation_tcpa,
)
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end = c.reals("begin end")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.opaque(
        horizontal_interval_tcpa, horizontal_violation_tcpa, layer_violation, vertical_interval
    )
    limits = (dthr, zthr, tthr, tcoa, vmod)
    back = (Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y), 0 - sz, 0 - vz)
    low, high = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    low_back, high_back = c.use(vertical_interval, 0 - sz, 0 - vz, zthr, tcoa, vmod, begin, end)
    c.lemma(
        "well_clear_vertical_volume_is_symmetric",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod, begin=begin, end=end,
    )  # fmt: skip
    c.lemma(
        "well_clear_horizontal_volumes_are_symmetric",
        s=s, v=v, dthr=dthr, tthr=tthr, begin=low, end=high,
    )  # fmt: skip
    c.congruence(
        horizontal_interval_tcpa,
        (back[0], back[1], dthr, tthr, low, high),
        (back[0], back[1], dthr, tthr, low_back, high_back),
    )
    ours = c.use(violation_tcpa, s, v, sz, vz, *limits)
    c.show(c.same(ours, c.use(violation_tcpa, *back, *limits)), "now")
    span = c.use(violation_interval_tcpa, s, v, sz, vz, *limits, begin, end)
    c.show(c.same(span, c.use(violation_interval_tcpa, *back, *limits, begin, end)), "the span")
