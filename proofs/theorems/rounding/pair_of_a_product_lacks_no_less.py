"""What is counted as left out of a product of two pairs of doubles can all be missing at once, so that
no smaller count would do."""

from cratous.core.readings.exact.certainty import factors_left_out, product_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    a_high, a_low, a_left = c.reals("a_high a_low a_left")
    b_high, b_low, b_left = c.reals("b_high b_low b_left")
    cross_a, cross_b, lows, share = c.reals("cross_a cross_b lows share")
    crosses_rest, rest, least = c.reals("crosses_rest rest least")
    sizes = (a_high, a_low, a_left, b_high, b_low, b_left, cross_a, cross_b, lows, share)
    for size in (*sizes, crosses_rest, rest):
        c.premise(size >= 0)
    # each rounded product is as much too small as it may be
    for result, real in (
        (cross_a, a_high * b_low),
        (cross_b, a_low * b_high),
        (lows, a_low * b_low),
    ):
        c.premise(real == result + share * result)
        c.premise(c.define(rounding.rounded, result, real, share, 0))
    real = (a_high + a_low + a_left) * (b_high + b_low + b_left)
    pair = a_high * b_high + cross_a + cross_b - crosses_rest - rest
    of_factors = c.use(factors_left_out, a_left, b_left, a_high + a_low, b_high + b_low)
    left = c.use(product_left_out, of_factors, cross_a, cross_b, lows, crosses_rest, rest, share)
    enough = c.define(rounding.stands_for, pair, 0, real, least)
    c.show(c.implies(enough, left <= least))
