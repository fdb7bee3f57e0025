"""At every instant of [B, T] the horizontal volume with tep is violated exactly if the instant lies
in the span that the interval kernel gives; for every relative state in any frame."""

from cratous.core.well_clear import horizontal_interval_tep
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, begin, end, t = c.reals("dthr tthr begin end t")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    span = c.use(horizontal_interval_tep, s, v, dthr, tthr, begin, end)
    violated = c.define(well_clear.horizontal_violation_tep_at, s, v, dthr, tthr, t)
    c.show(c.same(violated, c.define(well_clear.in_span, *span, t)))
