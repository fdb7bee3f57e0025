"""If the kernel says that the intruder stays outside the closed cylinder during [B, T] of straight
flight, then at no instant of [B, T] is it inside."""

from cratous.core.well_clear import cylinder_during, violation_during_tep
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_cylinder, any_instants
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz, radius, half = any_cylinder(c)
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(violation_during_tep, well_clear.violation_tep_at)
    detected = c.use(cylinder_during, s, v, sz, vz, radius, half, begin, end)
    size = {"dthr": radius, "zthr": half, "tthr": 0, "tcoa": 0, "vmod": 0}
    c.lemma(
        "well_clear_detection_tep_misses_no_instant",
        s=s, v=v, sz=sz, vz=vz, begin=begin, end=end, t=t, **size,
    )  # fmt: skip
    c.lemma(
        "well_clear_tep_without_time_is_the_cylinder",
        s=s, v=v, sz=sz, vz=vz, radius=radius, half=half, t=t,
    )  # fmt: skip
    inside = c.define(well_clear.cylinder_violation_at, s, v, sz, vz, radius, half, t)
    c.show(c.implies(inside, detected))
