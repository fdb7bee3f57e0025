"""Against a tube that grows steadily a hold is refused as above for ever only if there is an instant, which can be
named, at which it is no farther above than the radius."""

from cratous.core.permit.for_ever import above_for_ever
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    sz, vz, start, rate, far = c.reals("sz vz start rate far")
    growth = motion.Growth(start, rate, start - start)
    c.premise(c.all_of(start >= 0, rate >= 0))
    # where the tube climbs faster it is there at an instant, which is named
    c.premise(c.implies(c.all_of(vz < rate, sz > start), far * (rate - vz) == sz - start))
    above = c.use(above_for_ever, sz, vz, growth)
    c.step(c.implies(c.all_of(vz < rate, sz > start), far >= 0), "not before")
    instants = (start - start, far)
    some = [c.all_of(u >= 0, c.define(motion.levelled_at, sz, vz, growth, u)) for u in instants]
    c.show(c.implies(c.negation(above), c.any_of(*some)))
