"""Where the interval kernel for tep gives a span that is not empty, the kernel that does not ask
gives the same first and last instant."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    times_tep,
    times_vertical,
    vertical_interval,
    violation_interval_tep,
    violation_times_tep,
)
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end = c.reals("begin end")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    up = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    plain = c.use(times_vertical, sz, vz, zthr, tcoa, vmod, begin, end)
    c.show(c.implies(up.first_s <= up.last_s, c.same(plain, up)), "vertical")
    flat = c.use(horizontal_interval_tep, s, v, dthr, tthr, begin, end)
    plain = c.use(times_tep, s, v, dthr, tthr, begin, end)
    c.show(c.implies(flat.first_s <= flat.last_s, c.same(plain, flat)), "horizontal")
    limits = (dthr, zthr, tthr, tcoa, vmod, begin, end)
    span = c.use(violation_interval_tep, s, v, sz, vz, *limits)
    times = c.use(violation_times_tep, s, v, sz, vz, *limits)
    c.show(c.implies(span.first_s <= span.last_s, c.same(times, span)), "in space")
