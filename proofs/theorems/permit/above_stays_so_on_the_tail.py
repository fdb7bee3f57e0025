"""Where a piece is taken to be above a tube, so is what is left of it after any part has been flown."""

from cratous.core.permit.pieces import above_during, growth_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.meetings import any_growth
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    growth = any_growth(c)
    sz, vz, d, k = c.reals("sz vz d k")
    c.premise(c.all_of(k >= 0, k <= d))
    above = c.use(above_during, sz, vz, growth, d)
    named = {"start": growth.start_m, "rate": growth.rate_m_s, "gain": growth.gain_m_s2}
    c.lemma("permit_above_is_exact", sz=sz, vz=vz, d=d, t=k, **named)
    left = c.use(growth_after, growth, k)
    end = c.define(motion.reach, growth, d)
    c.step(c.define(motion.reach, left, d - k) == end, "the same end")
    after = c.use(above_during, sz + k * vz, vz, left, d - k)
    c.show(c.implies(above, after))
