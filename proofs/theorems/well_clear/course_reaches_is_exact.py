"""A straight course comes within a distance for the kernel exactly when it does at some time, past or
future: no time is missed, and the closest approach is one."""

from cratous.core.well_clear import course_reaches
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, t, closest = c.reals("dthr t closest")
    c.premise(dthr >= 0)
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    reaches = c.use(course_reaches, s, v, dthr)
    c.show(c.implies(c.define(well_clear.within_at, s, v, dthr, t), reaches), "no time is missed")
    c.show(c.implies(reaches, c.define(well_clear.within_at, s, v, dthr, closest)), "the closest")
