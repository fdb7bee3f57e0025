"""The model of rounding forbids no more than that two numbers turn round: that their rounded difference
is surely positive although the real one is not."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    less, more, less_rounded, more_rounded = c.reals("less more less_rounded more_rounded")
    real = c.use(surely_above, less - more, 0)
    rounded = c.use(surely_above, less_rounded - more_rounded, 0)
    turned = c.all_of(rounded, c.negation(real))
    kept = c.define(rounding.keeps_order, less, more, less_rounded, more_rounded)
    c.show(c.same(kept, c.negation(turned)))
