"""A piece is taken to be above a tube exactly when it is farther above than the radius at every instant of
it, however the radius grows; where it is refused, it is not so at its begin or at its end."""

from cratous.core.permit.pieces import above_during
from cratous.proofs.claim import Claim
from cratous.proofs.methods.meetings import any_growth
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    growth = any_growth(c)
    sz, vz, d, t = c.reals("sz vz d t")
    c.premise(c.all_of(t >= 0, t <= d))
    above = c.use(above_during, sz, vz, growth, d)
    left = sz + t * vz - c.define(motion.reach, growth, t)
    end = sz + d * vz - c.define(motion.reach, growth, d)
    c.step(
        d * left
        == (d - t) * (sz - growth.start_m) + t * end + d * growth.gain_m_s2 * (t * (d - t)),
        "above the line between the ends",
    )
    c.step(growth.gain_m_s2 * (t * (d - t)) >= 0, "within the piece")
    c.show(c.implies(above, c.negation(c.define(motion.levelled_at, sz, vz, growth, t))), "at each")
    ends = [c.define(motion.levelled_at, sz, vz, growth, at) for at in (d - d, d)]
    c.show(c.implies(c.negation(above), c.any_of(*ends)), "a witness")
