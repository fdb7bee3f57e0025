"""Where the interval kernel for taumod gives a span that is not empty, the kernel that does not ask
gives the same first and last instant."""

from cratous.core.well_clear import (
    horizontal_interval_taumod,
    times_taumod,
    times_vertical,
    vertical_interval,
    violation_interval_taumod,
    violation_times_taumod,
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
    flat = c.use(horizontal_interval_taumod, s, v, dthr, tthr, begin, end)
    plain = c.use(times_taumod, s, v, dthr, tthr, begin, end)
    c.show(c.implies(flat.first_s <= flat.last_s, c.same(plain, flat)), "horizontal")
    limits = (dthr, zthr, tthr, tcoa, vmod, begin, end)
    span = c.use(violation_interval_taumod, s, v, sz, vz, *limits)
    times = c.use(violation_times_taumod, s, v, sz, vz, *limits)
    c.show(c.implies(span.first_s <= span.last_s, c.same(times, span)), "in space")
