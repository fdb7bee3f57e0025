"""The horizontal volume with tep is monotone: a greater DTHR or TTHR never makes a violation
vanish."""

from cratous.core.well_clear import horizontal_violation_tep
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, dthr2, tthr2 = c.reals("dthr tthr dthr2 tthr2")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    c.premise(dthr <= dthr2)
    c.premise(tthr <= tthr2)
    before = c.use(horizontal_violation_tep, s, v, dthr, tthr)
    wider = c.use(horizontal_violation_tep, s, v, dthr2, tthr)
    c.step(c.implies(before, wider), "in DTHR")
    after = c.use(horizontal_violation_tep, s, v, dthr2, tthr2)
    c.step(c.implies(wider, after), "in TTHR")
    c.show(c.implies(before, after), "in both")
