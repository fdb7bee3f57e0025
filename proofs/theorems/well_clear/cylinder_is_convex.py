"""The closed cylinder is locally convex: if the intruder is inside at two instants of straight
flight, it is inside at every instant between them, in any frame."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear.interval import violation_interval_tep
from cratous.core.well_clear.now import cylinder_violation, violation_tep
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_cylinder, any_instants
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz, radius, half = any_cylinder(c)
    early, middle, late = any_instants(c, "early middle late")
    c.opaque(
        violation_interval_tep,
        violation_tep,
        cylinder_violation,
        well_clear.violation_tep_at,
        well_clear.cylinder_violation,
    )
    inside = []
    for t in (early, middle, late):
        then = Vec2(s.x + t * v.x, s.y + t * v.y)
        inside.append(c.use(cylinder_violation, then, sz + t * vz, radius, half))
        at = c.define(well_clear.cylinder_violation_at, s, v, sz, vz, radius, half, t)
        c.lemma(
            "well_clear_cylinder_violation_is_its_definition",
            s=then, sz=sz + t * vz, radius=radius, half=half,
        )  # fmt: skip
        c.show(c.same(inside[-1], at), "the kernel")
    zero = early - early
    c.lemma(
        "well_clear_tep_is_convex",
        s=s, v=v, sz=sz, vz=vz, dthr=radius, zthr=half, tthr=zero, tcoa=zero, vmod=zero,
        early=early, middle=middle, late=late,
    )  # fmt: skip
    for t in (early, middle, late):
        c.lemma(
            "well_clear_tep_without_time_is_the_cylinder",
            s=s, v=v, sz=sz, vz=vz, radius=radius, half=half, t=t,
        )  # fmt: skip
    c.show(c.implies(c.all_of(inside[0], inside[2]), inside[1]), "convex")
