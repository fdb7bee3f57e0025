"""The cylinder is symmetric and monotone in radius and height, closed and open; and the instants of
straight flight inside the closed one have no gap."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import cylinder_conflict, cylinder_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half, radius2, half2 = c.reals("sz vz radius half radius2 half2")
    early, middle, late = c.reals("early middle late")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    c.premise(radius <= radius2)
    c.premise(half <= half2)
    c.premise(early <= middle)
    c.premise(middle <= late)
    back = Vec2(0 - s.x, 0 - s.y)
    for kernel in (cylinder_violation, cylinder_conflict):
        ours = c.use(kernel, s, sz, radius, half)
        c.show(c.same(ours, c.use(kernel, back, 0 - sz, radius, half)), "symmetric")
        c.show(c.implies(ours, c.use(kernel, s, sz, radius2, half2)), "monotone")
    inside = [
        c.define(well_clear.cylinder_violation_at, s, v, sz, vz, radius, half, t)
        for t in (early, middle, late)
    ]
    c.show(c.implies(c.all_of(inside[0], inside[2]), inside[1]), "convex")
