"""Where a computed value exceeds its error bound, the real number it stands for is positive, where
it is below minus the bound negative; and wherever neither is so, a real number within the bound
has the other sign, or is zero."""

from cratous.core.certainty import surely_above, surely_below
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    value, real, size, bound = c.reals("value real size bound")
    c.premise(bound >= 0)
    c.premise(c.define(rounding.near, value, real, size, bound))
    above, below = c.use(surely_above, value, bound), c.use(surely_below, value, bound)
    c.show(c.same(above, c.define(rounding.surely_positive, value, bound)), "above: definition")
    c.show(c.same(below, c.define(rounding.surely_negative, value, bound)), "below: definition")
    c.show(c.implies(above, real > 0), "above")
    c.show(c.implies(below, real < 0), "below")
    # the worst cases: the real number at either end of the bound
    c.show(c.any_of(above, value - bound <= 0), "above: no earlier")
    c.show(c.any_of(below, value + bound >= 0), "below: no earlier")
