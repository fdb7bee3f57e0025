"""A radius that is counted from later on is the same radius: at every instant after, it is as large, and its
kernels are their definitions."""

from cratous.core.permit.pieces import growth_after, reach_after
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    growth = motion.Growth(*c.reals("start rate gain"))
    t, more = c.reals("t more")
    c.show(c.same(c.use(reach_after, growth, t), c.define(motion.reach, growth, t)), "the radius")
    after = c.use(growth_after, growth, t)
    c.show(c.same(after, c.define(motion.later, growth, t)), "counted from then on")
    whole = c.define(motion.reach, growth, t + more)
    c.show(c.same(c.use(reach_after, after, more), whole), "the same radius")
