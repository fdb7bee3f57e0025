"""If well clear by tep is lost at some instant of [B, T], it is lost at exactly the instants of [B, T]
between the first and the last one that the kernel gives, these two included."""

from cratous.core.well_clear import violation_interval_tep, violation_times_tep
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, some, t = c.reals("begin end some t")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    for instant in (some, t):
        c.premise(c.all_of(begin <= instant, instant <= end))
    c.opaque(violation_interval_tep, violation_times_tep, well_clear.violation_tep_at)
    limits = (dthr, zthr, tthr, tcoa, vmod)
    size = {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    for instant in (some, t):
        c.lemma("well_clear_interval_tep_is_exact", t=instant, **state, **size)
    c.lemma("well_clear_times_tep_are_the_interval", **state, **size)
    c.premise(c.define(well_clear.violation_tep_at, s, v, sz, vz, *limits, some))
    times = c.use(violation_times_tep, s, v, sz, vz, *limits, begin, end)
    lost = c.define(well_clear.violation_tep_at, s, v, sz, vz, *limits, t)
    c.show(c.same(lost, c.define(well_clear.in_span, *times, t)))
