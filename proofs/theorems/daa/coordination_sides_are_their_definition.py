"""The side on which an intruder is passed, and who goes above, are what their definitions say, in every
state: head-on, without relative motion, in one place, at one altitude."""

from cratous.core.daa.coordination import horizontal_side, side_of, vertical_side
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz = c.reals("sz vz")
    enters, first = c.boolean("enters"), c.boolean("first")
    high, low = c.reals("high low")
    side = c.use(side_of, high, low, first)
    c.show(c.same(side, c.define(daa_coordination.vertical_side, high - low, first)), "of two")
    passed = c.use(horizontal_side, s, v)
    c.show(c.same(passed, c.define(daa_coordination.horizontal_side, s, v)), "horizontal")
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    together = c.all_of(s.x == 0, s.y == 0, sz == 0)
    above = c.use(vertical_side, sz, vz, vv, sv, together, enters, first)
    height = c.define(daa_coordination.height_that_decides, s, v, sz, vz, enters)
    c.show(c.same(above, c.define(daa_coordination.vertical_side, height, first)), "vertical")
