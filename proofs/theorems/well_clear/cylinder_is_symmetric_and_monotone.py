"""The cylinder is symmetric and monotone in radius and height, closed and open."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import cylinder_conflict, cylinder_violation
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s = c.vector("s")
    sz, radius, half, radius2, half2 = c.reals("sz radius half radius2 half2")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    c.premise(radius <= radius2)
    c.premise(half <= half2)
    back = Vec2(0 - s.x, 0 - s.y)
    for kernel in (cylinder_violation, cylinder_conflict):
        ours = c.use(kernel, s, sz, radius, half)
        c.show(c.same(ours, c.use(kernel, back, 0 - sz, radius, half)), "symmetric")
        c.show(c.implies(ours, c.use(kernel, s, sz, radius2, half2)), "monotone")
