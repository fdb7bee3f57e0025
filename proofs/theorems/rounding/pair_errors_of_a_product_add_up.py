"""The errors of a product of two pairs of doubles add up: those of the factors, of the rounded cross
products, the dropped product of the low parts, and what sums round off."""

from cratous.core.readings.exact.certainty import sum_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    highs_real, cross_a_real, cross_b_real, lows_real = c.reals("highs cross_a cross_b lows")
    error_a, error_b, error_both, of_a, of_b, of_both = c.reals(
        "error_a error_b error_both of_a of_b of_both"
    )
    cross_a, cross_b, share_a, share_b, of_lows = c.reals("made_a made_b share_a share_b of_lows")
    highs, highs_rest, crosses, crosses_rest = c.reals("sum rest_of_sum crosses crosses_rest")
    middle, rest, high, low = c.reals("middle rest high low")
    for error, bound in ((error_a, of_a), (error_b, of_b), (error_both, of_both)):
        c.premise(c.define(rounding.stands_for, 0, 0, error, bound))
    c.premise(c.define(rounding.stands_for, cross_a, 0, cross_a_real, share_a))
    c.premise(c.define(rounding.stands_for, cross_b, 0, cross_b_real, share_b))
    c.premise(c.define(rounding.stands_for, 0, 0, lows_real, of_lows))
    c.premise(highs + highs_rest == highs_real)
    c.premise(crosses + crosses_rest == cross_a + cross_b)
    c.premise(middle + rest == highs_rest + crosses)
    c.premise(high + low == highs + middle)
    parts = highs_real + cross_a_real + cross_b_real + lows_real
    errors = error_a + error_b + error_both
    bounds = of_a + of_b + of_both
    left = c.use(sum_left_out, bounds, share_a + share_b + of_lows, crosses_rest, rest)
    c.show(c.define(rounding.stands_for, high, low, parts + errors, left))
