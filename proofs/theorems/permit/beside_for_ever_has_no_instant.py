"""A hold that is taken to be beside a tube for ever has its centre farther from the prediction than the radius at
every instant from now on; of a tube that grows faster and faster none is."""

from cratous.core.permit.for_ever import beside_for_ever, ever_dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, gain, t = c.reals("start rate gain t")
    growth = motion.Growth(start, rate, gain)
    c.premise(c.all_of(start >= 0, rate >= 0, gain >= 0, t >= 0))
    c.opaque(ever_dips_to_zero)
    beside = c.use(beside_for_ever, s, v, growth)
    a = v.x * v.x + v.y * v.y - rate * rate
    b = 2 * (s.x * v.x + s.y * v.y - start * rate)
    k = s.x * s.x + s.y * s.y - start * start
    c.lemma("permit_parabola_for_ever_misses_no_instant", a=a, b=b, c=k, t=t)
    x, y, line = s.x + t * v.x, s.y + t * v.y, start + t * rate
    value = c.define(well_clear.parabola, a, b, k, t)
    c.step(value == x * x + y * y - line * line, "the square")
    c.step(t * rate >= 0, "no radius below 0")
    c.step(c.implies(gain == 0, c.define(motion.reach, growth, t) == line), "the radius")
    c.show(c.implies(beside, c.negation(c.define(motion.reached_at, s, v, growth, t))), "at none")
    c.show(c.implies(gain > 0, c.negation(beside)), "no tube that grows ever faster")
