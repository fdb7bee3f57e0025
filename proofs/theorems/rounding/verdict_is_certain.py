"""Where a computed value exceeds its error bound, the real number it stands for is positive, where
it is below minus the bound negative, the sum that decides that being rounded or not; and wherever
neither is so, a real number within the bound has the other sign, or is zero."""

from cratous.core.readings.exact.certainty import surely_above, surely_below
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    value, real, size, bound, total, unit = c.reals("value real size bound total unit")
    c.premise(bound >= 0)
    c.premise(c.define(rounding.near, value, real, size, bound))
    c.premise(c.all_of(unit > 0, unit < 1))
    c.premise(c.define(rounding.rounded, total, value + bound, unit, 0))
    above, below = c.use(surely_above, value, bound), c.use(surely_below, value, bound)
    positive = c.define(rounding.surely_positive, real, value, bound)
    negative = c.define(rounding.surely_negative, real, value, bound)
    c.show(c.implies(above, positive), "above: definition")
    c.show(c.implies(below, negative), "below: definition")
    c.show(c.implies(above, real > 0), "above")
    c.show(c.implies(below, real < 0), "below")
    # the worst cases: the real number at either end of the bound
    least = c.define(rounding.surely_positive, value - bound, value, bound)
    most = c.define(rounding.surely_negative, value + bound, value, bound)
    c.show(c.implies(least, above), "above: no earlier")
    c.show(c.implies(most, below), "below: no earlier")
    c.show(c.same(below, c.use(surely_below, total, 0)), "below: the rounded sum says the same")
