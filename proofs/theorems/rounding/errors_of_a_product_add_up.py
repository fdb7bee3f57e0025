"""Where the four parts of a product of sums are bounded, the rounded product of the main parts
stands for the whole within the bounds of the other three, one rounding and one underflow."""

from cratous.core.readings.exact.certainty import surely_above, surely_below
from cratous.proofs.claim import Claim
from cratous.proofs.methods.products import any_rounding
from cratous.spec import rounding


def claim(c: Claim) -> None:
    main, one, two, both = c.reals("main one two both")
    sizes, bound_one, bound_two, bound_both = c.reals("sizes bound_one bound_two bound_both")
    value, p, unit, tiny = any_rounding(c)
    for part, most in ((main, sizes), (one, bound_one), (two, bound_two), (both, bound_both)):
        c.premise(c.define(rounding.near, part, part, most, 0))
    c.premise(c.define(rounding.rounded, p, sizes, unit, tiny))
    c.premise(c.define(rounding.rounded, value, main, unit, tiny))
    c.premise(
        c.define(rounding.keeps_order, c.define(abs_of, main), sizes, c.define(abs_of, value), p)
    )
    c.show(sizes <= p + unit * p + tiny, "the sizes")
    bound = bound_one + bound_two + bound_both + unit * p + tiny
    real = main - one - two + both
    c.show(c.define(rounding.near, value, real, p, bound), "the product")
    c.show(c.implies(c.use(surely_above, value, bound), real > 0), "positive")
    c.show(c.implies(c.use(surely_below, value, bound), real < 0), "negative")


def abs_of(x: float) -> float:
    """The magnitude."""
    return abs(x)
