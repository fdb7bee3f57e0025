"""Where a piece is taken to be beside a tube, the centres are farther apart than its radius at every instant
of the piece, however the radius grows."""

from cratous.core.permit.pieces import beside_during
from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.proofs.methods.meetings import any_growth
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    growth = any_growth(c)
    d, t = c.reals("d t")
    c.premise(c.all_of(t >= 0, t <= d))
    c.opaque(dips_to_zero)
    beside = c.use(beside_during, s, v, growth, d)
    chord = growth.rate_m_s + d * growth.gain_m_s2
    a = v.x * v.x + v.y * v.y - chord * chord
    b = 2 * (s.x * v.x + s.y * v.y - growth.start_m * chord)
    k = s.x * s.x + s.y * s.y - growth.start_m * growth.start_m
    c.lemma("permit_parabola_of_any_sign_misses_no_instant", a=a, b=b, c=k, h=d, t=t)
    x, y = s.x + t * v.x, s.y + t * v.y
    line = growth.start_m + t * chord
    c.step(a * t * t + b * t + k == x * x + y * y - line * line, "against the chord")
    c.step(c.implies(beside, x * x + y * y > line * line), "farther than the chord")
    reach = c.define(motion.reach, growth, t)
    c.step(line - reach == growth.gain_m_s2 * (t * (d - t)), "the chord against the radius")
    c.step(t * (d - t) >= 0, "within the piece")
    c.step(c.all_of(reach >= 0, reach <= line), "the chord is never below the radius")
    c.step(reach * reach <= line * line, "in squares")
    c.show(c.implies(beside, c.negation(c.define(motion.reached_at, s, v, growth, t))))
