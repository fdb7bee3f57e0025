"""The pair of doubles that is left of a product of two pairs, when the product of the low parts and
what sums and products round off are dropped, stands for the product of the two real numbers within
what is counted as left out."""

from cratous.core.readings.exact.certainty import factors_left_out, product_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding

SIZE = "rounding_size_of_a_product_is_bounded"


def claim(c: Claim) -> None:
    a_high, a_low, a_error, a_left, a_size = c.reals("a_high a_low a_error a_left a_size")
    b_high, b_low, b_error, b_left, b_size = c.reals("b_high b_low b_error b_left b_size")
    cross_a, cross_b, lows, share = c.reals("cross_a cross_b lows share")
    highs, highs_rest, crosses, crosses_rest = c.reals("highs highs_rest crosses crosses_rest")
    middle, rest, high, low = c.reals("middle rest high low")
    a, b = a_high + a_low + a_error, b_high + b_low + b_error
    c.premise(c.define(rounding.stands_for, a_high, a_low, a, a_left))
    c.premise(c.define(rounding.stands_for, b_high, b_low, b, b_left))
    c.premise(c.define(magnitude, a_high + a_low) <= a_size)
    c.premise(c.define(magnitude, b_high + b_low) <= b_size)
    c.premise(c.define(rounding.rounded, cross_a, a_high * b_low, share, 0))
    c.premise(c.define(rounding.rounded, cross_b, a_low * b_high, share, 0))
    c.premise(c.define(rounding.rounded, lows, a_low * b_low, share, 0))
    # the product of doubles and sums of them, with their exact rests
    c.premise(highs + highs_rest == a_high * b_high)
    c.premise(crosses + crosses_rest == cross_a + cross_b)
    c.premise(middle + rest == highs_rest + crosses)
    c.premise(high + low == highs + middle)
    c.lemma(SIZE, x=a_error, most_x=a_left, y=b_high + b_low, most_y=b_size)
    c.lemma(SIZE, x=a_error, most_x=a_left, y=b_error, most_y=b_left)
    c.lemma(SIZE, x=a_high + a_low, most_x=a_size, y=b_error, most_y=b_left)
    size_a, size_b, size_low = (c.define(magnitude, x) for x in (cross_a, cross_b, lows))
    c.lemma(
        "rounding_pair_errors_of_a_product_add_up",
        highs=a_high * b_high,
        cross_a=a_high * b_low,
        cross_b=a_low * b_high,
        lows=a_low * b_low,
        error_a=a_error * (b_high + b_low),
        error_b=(a_high + a_low) * b_error,
        error_both=a_error * b_error,
        of_a=a_left * b_size,
        of_b=a_size * b_left,
        of_both=a_left * b_left,
        made_a=cross_a,
        made_b=cross_b,
        share_a=share * size_a,
        share_b=share * size_b,
        of_lows=share * size_low + size_low,
        sum=highs,
        rest_of_sum=highs_rest,
        crosses=crosses,
        crosses_rest=crosses_rest,
        middle=middle,
        rest=rest,
        high=high,
        low=low,
    )
    of_factors = c.use(factors_left_out, a_left, b_left, a_size, b_size)
    left = c.use(product_left_out, of_factors, cross_a, cross_b, lows, crosses_rest, rest, share)
    c.show(c.define(rounding.stands_for, high, low, a * b, left))


def magnitude(x: float) -> float:
    """The magnitude."""
    return abs(x)
