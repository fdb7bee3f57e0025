"""Where well clear by the buffered thresholds is predicted to hold during a piece of flight, the mission's own cylinder is
not entered at any instant of it, whatever places the vehicle has within rho of the way and the intruder in its tube,
however that grows, as long as rho, the tube and the cylinder together are no more than the buffered thresholds."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import cylinder_violation, violation_within
from cratous.core.well_clear.thresholds import StandardThresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa
from cratous.proofs.methods.meetings import (
    about,
    any_guard,
    margins_by_name,
    offs_by_name,
    tube_by_name,
)
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    (s, v, sz, vz), sizes = any_by_tcoa(c)
    dthr, zthr, tthr, tcoa = sizes
    tube, margins, offs = any_guard(c)
    h, t = c.reals("h t")
    c.premise(c.all_of(t >= 0, t <= h))
    around, layer = about(tube, margins)
    wide, high = (c.define(motion.reach, growth, t) for growth in (around, layer))
    c.premise(c.all_of(wide <= dthr, high <= zthr))
    c.opaque(
        violation_within,
        cylinder_violation,
        well_clear.horizontal_violation,
        well_clear.within,
        well_clear.vertical_violation_at,
    )
    lost = c.use(violation_within, s, v, sz, vz, StandardThresholds(*sizes), h)
    c.lemma(
        "well_clear_violation_within_misses_no_instant",
        s=s, v=v, sz=sz, vz=vz, dthr=dthr, zthr=zthr, tthr=tthr, tcoa=tcoa, h=h, t=t,
    )  # fmt: skip
    c.lemma(
        "permit_entered_is_near", s=s, v=v, sz=sz, vz=vz, t=t,
        **margins_by_name(margins), **tube_by_name(tube), **offs_by_name(offs),
    )  # fmt: skip
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    c.lemma("permit_within_turns_scales_and_grows", p=there, most=wide, more=dthr, times=t)
    c.lemma(
        "well_clear_cylinder_violation_is_its_definition",
        s=there,
        sz=sz + t * vz,
        radius=dthr,
        half=zthr,
    )
    c.lemma(
        "well_clear_the_cylinder_is_part_of_the_volume",
        s=s, v=v, sz=sz, vz=vz, dthr=dthr, zthr=zthr, tthr=tthr, tcoa=tcoa, t=t,
    )  # fmt: skip
    hit = c.define(motion.hit_at, s, v, sz, vz, offs, tube, margins, t)
    c.show(c.implies(c.negation(lost), c.negation(hit)))
