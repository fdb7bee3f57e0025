"""The cylinder kernels say `inside` exactly when the definitions do, closed and open, for every
relative position and size not below zero."""

from cratous.core.well_clear import cylinder_conflict, cylinder_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s = c.vector("s")
    sz, radius, half = c.reals("sz radius half")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    closed = c.use(cylinder_violation, s, sz, radius, half)
    wanted = c.define(well_clear.cylinder_violation, s, sz, radius, half)
    c.show(c.same(closed, wanted), "closed")
    opened = c.use(cylinder_conflict, s, sz, radius, half)
    c.show(c.same(opened, c.define(well_clear.cylinder_conflict, s, sz, radius, half)), "open")
    c.show(c.implies(opened, closed), "the open one lies in the closed one")
