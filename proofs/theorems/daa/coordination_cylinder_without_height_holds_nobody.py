"""A cylinder whose height is below 0 holds nobody, for the kernel that asks whether two will be in one."""

from cratous.core.daa.coordination import enters_cylinder
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half = c.reals("sz vz radius half")
    c.premise(half < 0)
    c.show(c.negation(c.use(enters_cylinder, s, v, sz, vz, radius, half)))
