"""The pair of doubles that is left of a sum of two pairs, when what low parts round off is dropped,
stands for the sum of the two real numbers within what is counted as left out."""

from cratous.core.readings.exact.certainty import sum_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    a_high, a_low, a, a_left = c.reals("a_high a_low a a_left")
    b_high, b_low, b, b_left = c.reals("b_high b_low b b_left")
    highs, highs_rest, lows, lows_rest = c.reals("highs highs_rest lows lows_rest")
    middle, rest, high, low = c.reals("middle rest high low")
    c.premise(c.define(rounding.stands_for, a_high, a_low, a, a_left))
    c.premise(c.define(rounding.stands_for, b_high, b_low, b, b_left))
    # sums of doubles with their exact rests
    c.premise(highs + highs_rest == a_high + b_high)
    c.premise(lows + lows_rest == a_low + b_low)
    c.premise(middle + rest == highs_rest + lows)
    c.premise(high + low == highs + middle)
    left = c.use(sum_left_out, a_left, b_left, lows_rest, rest)
    c.show(c.define(rounding.stands_for, high, low, a + b, left))
