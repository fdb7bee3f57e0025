"""Two that are in the closed cylinder have lost well clear: horizontally and vertically, by whatever thresholds of time."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import cylinder_violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    (s, v, sz, vz), (dthr, zthr, tthr, tcoa) = any_by_tcoa(c)
    t = c.real("t")
    there = Vec2(s.x + t * v.x, s.y + t * v.y)
    inside = c.use(cylinder_violation, there, sz + t * vz, dthr, zthr)
    beside = c.define(well_clear.horizontal_violation, there, v, dthr, tthr)
    c.show(c.implies(inside, beside), "horizontally")
    level = c.define(well_clear.vertical_violation_at, sz, vz, zthr, tcoa, t)
    c.show(c.implies(inside, level), "vertically")
