"""At every instant of [B, T] of straight flight the intruder is inside the closed cylinder exactly if
the instant lies in the span that the kernel gives; a span that is not empty lies within [B, T], and
an empty one is from 1 to 0."""

from cratous.core.well_clear import cylinder_interval, violation_interval_tep
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_cylinder, any_instants
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz, radius, half = any_cylinder(c)
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(violation_interval_tep, well_clear.violation_tep_at)
    first, last = c.use(cylinder_interval, s, v, sz, vz, radius, half, begin, end)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end}
    size = {"dthr": radius, "zthr": half, "tthr": 0, "tcoa": 0, "vmod": 0}
    c.lemma("well_clear_interval_tep_is_exact", t=t, **state, **size)
    c.lemma("well_clear_interval_tep_first_and_last_violate", **state, **size)
    c.lemma(
        "well_clear_tep_without_time_is_the_cylinder",
        s=s, v=v, sz=sz, vz=vz, radius=radius, half=half, t=t,
    )  # fmt: skip
    inside = c.define(well_clear.cylinder_violation_at, s, v, sz, vz, radius, half, t)
    c.show(c.same(inside, c.define(well_clear.in_span, first, last, t)), "exact")
    c.show(c.implies(first <= last, c.all_of(begin <= first, last <= end)), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
