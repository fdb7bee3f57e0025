"""For every relative state and all thresholds not below zero, the horizontal kernel with tau says
`violated` exactly when the definition does."""

from cratous.core.well_clear import horizontal_violation_tau
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    verdict = c.use(horizontal_violation_tau, s, v, dthr, tthr)
    c.show(c.same(verdict, c.define(well_clear.horizontal_violation_tau, s, v, dthr, tthr)))
