"""A product of two computed values, rounded, stands for the product of the two real numbers within
the errors that the bounds of the factors leave, plus one rounding of the size of the result and
one underflow; where it exceeds that, the real product is positive."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.proofs.methods.products import any_rounding
from cratous.spec import rounding

SIZE = "rounding_size_of_a_product_is_bounded"


def claim(c: Claim) -> None:
    v1, e1, p1, b1 = c.reals("v1 e1 p1 b1")
    v2, e2, p2, b2 = c.reals("v2 e2 p2 b2")
    value, p, unit, tiny = any_rounding(c)
    # the real factors are v1 - e1 and v2 - e2
    c.premise(c.define(rounding.near, v1, v1 - e1, p1, b1))
    c.premise(c.define(rounding.near, v2, v2 - e2, p2, b2))
    c.premise(c.define(rounding.rounded, p, p1 * p2, unit, tiny))
    c.premise(c.define(rounding.rounded, value, v1 * v2, unit, tiny))
    size = c.define(abs_of, v1 * v2)
    c.premise(c.define(rounding.keeps_order, size, p1 * p2, c.define(abs_of, value), p))
    c.lemma(SIZE, x=v1, most_x=p1, y=v2, most_y=p2)
    c.lemma(SIZE, x=v1, most_x=p1, y=e2, most_y=b2)
    c.lemma(SIZE, x=e1, most_x=b1, y=v2, most_y=p2)
    c.lemma(SIZE, x=e1, most_x=b1, y=e2, most_y=b2)
    c.lemma(
        "rounding_errors_of_a_product_add_up",
        main=v1 * v2,
        one=v1 * e2,
        two=e1 * v2,
        both=e1 * e2,
        sizes=p1 * p2,
        bound_one=p1 * b2,
        bound_two=b1 * p2,
        bound_both=b1 * b2,
        value=value,
        p=p,
        unit=unit,
        tiny=tiny,
    )
    real = v1 * v2 - v1 * e2 - e1 * v2 + e1 * e2
    c.show((v1 - e1) * (v2 - e2) == real, "the real product")
    c.show(p1 * p2 <= p + unit * p + tiny, "the sizes")
    bound = p1 * b2 + b1 * p2 + b1 * b2 + unit * p + tiny
    c.show(c.define(rounding.near, value, real, p, bound), "the product")
    c.show(c.implies(c.use(surely_above, value, bound), real > 0), "its sign")


def abs_of(x: float) -> float:
    """The magnitude."""
    return abs(x)
