"""Whether two aircraft are in one cylinder at an instant is the same seen from either of them. Without
relative climb rate the kernel says no to both."""

from cratous.core.daa.coordination import enters_cylinder
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half, t = c.reals("sz vz radius half t")
    back = (Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y), 0 - sz, 0 - vz)
    ours = c.define(daa_coordination.in_cylinder_at, s, v, sz, vz, radius, half, t)
    theirs = c.define(daa_coordination.in_cylinder_at, *back, radius, half, t)
    c.show(c.same(ours, theirs), "at an instant")
    for view in ((s, v, sz, vz), back):
        found = c.use(enters_cylinder, *view, radius, half)
        c.show(c.implies(vz == 0, c.negation(found)), "no climb")
