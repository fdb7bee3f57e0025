"""If the intruder is inside the closed cylinder at some instant of [B, T], it is inside at exactly the
instants of [B, T] between the first and the last one that the kernel gives, these two included."""

from cratous.core.well_clear import cylinder_times, violation_times_tep
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half = c.reals("sz vz radius half")
    begin, end, some, t = c.reals("begin end some t")
    c.premise(c.all_of(radius >= 0, half >= 0))
    for instant in (some, t):
        c.premise(c.all_of(begin <= instant, instant <= end))
    c.opaque(violation_times_tep, well_clear.violation_tep_at)
    inside = []
    for instant in (some, t):
        where = {"s": s, "v": v, "sz": sz, "vz": vz, "radius": radius, "half": half}
        c.lemma("well_clear_tep_without_time_is_the_cylinder", t=instant, **where)
        within = (s, v, sz, vz, radius, half, instant)
        inside.append(c.define(well_clear.cylinder_violation_at, *within))
    c.premise(inside[0])
    c.lemma(
        "well_clear_times_tep_are_exact", s=s, v=v, sz=sz, vz=vz, dthr=radius, zthr=half,
        tthr=0, tcoa=0, vmod=0, begin=begin, end=end, some=some, t=t,
    )  # fmt: skip
    times = c.use(cylinder_times, s, v, sz, vz, radius, half, begin, end)
    c.show(c.same(inside[1], c.define(well_clear.in_span, *times, t)))
