"""For every relative state and all thresholds not below zero, the horizontal well-clear kernel
says `violated` exactly when the definition with modified tau does."""

from cratous.core.well_clear import horizontal_violation
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    verdict = c.use(horizontal_violation, s, v, dthr, tthr)
    c.show(c.same(verdict, c.define(well_clear.horizontal_violation, s, v, dthr, tthr)))
