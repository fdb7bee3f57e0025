"""The decision with tep on invariants agrees with the definition whenever the invariants are those
of a relative state."""

from cratous.core.well_clear import tep_decision
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    ss, vv = s.x * s.x + s.y * s.y, v.x * v.x + v.y * v.y
    sv, cross = s.x * v.x + s.y * v.y, s.x * v.y - s.y * v.x
    verdict = c.use(tep_decision, ss, vv, sv, cross, dthr * dthr, tthr)
    c.show(c.same(verdict, c.define(well_clear.horizontal_violation_tep, s, v, dthr, tthr)))
