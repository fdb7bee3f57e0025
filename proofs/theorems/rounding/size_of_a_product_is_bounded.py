"""A product of two numbers is at most the product of their bounds, so where its error bound
exceeds that it decides no sign."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    x, y, most_x, most_y = c.reals("x y most_x most_y")
    c.premise(c.define(rounding.near, x, x, most_x, 0))
    c.premise(c.define(rounding.near, y, y, most_y, 0))
    c.show(c.define(rounding.near, x * y, x * y, most_x * most_y, 0), "the size")
    c.show(c.negation(c.use(surely_above, x * y, most_x * most_y)), "no sign")
