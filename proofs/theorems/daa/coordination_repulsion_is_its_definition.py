"""A relative velocity repels, horizontally and vertically, exactly if its definition says so, to whatever side (a
number below 0 is the one, any other the other); and seen from the other aircraft, which flies on, it does as
well, vertically for the other side."""

from cratous.core.daa.coordination import repels, repels_vertically
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, v, w = c.vector("s"), c.vector("v"), c.vector("w")
    vz, wz = c.reals("vz wz")
    side = c.integer("side")
    found = c.use(repels, s, v, w, side)
    c.show(c.same(found, c.define(daa_coordination.repels, s, v, w, side)), "horizontal")
    high = c.use(repels_vertically, v, vz, w, wz, side)
    meant = c.define(daa_coordination.repels_vertically, v, vz, w, wz, side)
    c.show(c.same(high, meant), "vertical")
    r, x, y = (Vec2(0 - a.x, 0 - a.y) for a in (s, v, w))
    c.show(c.same(found, c.use(repels, r, x, y, side)), "seen from the other")
    seen = c.use(repels_vertically, x, 0 - vz, y, 0 - wz, 0 - side)
    c.show(c.implies(side != 0, c.same(high, seen)), "seen from the other, vertically")
