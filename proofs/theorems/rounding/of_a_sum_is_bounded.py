"""A sum or difference of two computed values, rounded, stands for that of the two real numbers
within the sum of their bounds plus one rounding of the size of the result; where it exceeds that,
the real sum is positive."""

from cratous.core.readings.exact.certainty import surely_above, surely_below
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    v1, r1, p1, b1 = c.reals("v1 r1 p1 b1")
    v2, r2, p2, b2 = c.reals("v2 r2 p2 b2")
    plus, minus, p, unit = c.reals("plus minus p unit")
    c.premise(unit > 0)
    c.premise(c.define(rounding.near, v1, r1, p1, b1))
    c.premise(c.define(rounding.near, v2, r2, p2, b2))
    c.premise(c.define(rounding.rounded, p, p1 + p2, unit, 0))
    c.premise(c.define(rounding.rounded, plus, v1 + v2, unit, 0))
    c.premise(c.define(rounding.rounded, minus, v1 - v2, unit, 0))
    for value, real in ((plus, v1 + v2), (minus, v1 - v2)):
        size = c.define(abs_of, real)
        c.premise(c.define(rounding.keeps_order, size, p1 + p2, c.define(abs_of, value), p))
    c.show(p1 + p2 <= p + unit * p, "the sizes")
    bound = b1 + b2 + unit * p
    c.show(c.define(rounding.near, plus, r1 + r2, p, bound), "the sum")
    c.show(c.define(rounding.near, minus, r1 - r2, p, bound), "the difference")
    c.show(c.implies(c.use(surely_above, minus, bound), r1 > r2), "greater")
    c.show(c.implies(c.use(surely_below, minus, bound), r1 < r2), "less")


def abs_of(x: float) -> float:
    """The magnitude."""
    return abs(x)
