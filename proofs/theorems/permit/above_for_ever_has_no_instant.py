"""A hold that is taken to be above a tube for ever is farther above it than the radius at every instant from
now on; of a tube that grows faster and faster none is."""

from cratous.core.permit.for_ever import above_for_ever
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    sz, vz, start, rate, gain, t = c.reals("sz vz start rate gain t")
    growth = motion.Growth(start, rate, gain)
    c.premise(c.all_of(start >= 0, rate >= 0, gain >= 0, t >= 0))
    above = c.use(above_for_ever, sz, vz, growth)
    c.step(c.implies(vz >= rate, t * (vz - rate) >= 0), "no slower")
    c.show(c.implies(above, c.negation(c.define(motion.levelled_at, sz, vz, growth, t))), "at none")
    c.show(c.implies(gain > 0, c.negation(above)), "no tube that grows ever faster")
