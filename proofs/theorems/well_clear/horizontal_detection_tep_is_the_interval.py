"""The horizontal kernel with tep that neither divides nor takes roots says `violated during [0, h]`
exactly when the interval kernel's span over [0, h] is not empty."""

from cratous.core.well_clear import horizontal_interval_tep, horizontal_violation_within_tep
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, h = c.reals("dthr tthr h")
    for nonnegative in (dthr, tthr, h):
        c.premise(nonnegative >= 0)
    detected = c.use(horizontal_violation_within_tep, s, v, dthr, tthr, h)
    first, last = c.use(horizontal_interval_tep, s, v, dthr, tthr, h - h, h)
    c.show(c.same(detected, first <= last))
