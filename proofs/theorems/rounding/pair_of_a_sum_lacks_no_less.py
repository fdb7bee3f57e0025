"""What is counted as left out of a sum of two pairs of doubles can all be missing at once, so that no
smaller count would do."""

from cratous.core.readings.exact.certainty import sum_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    a_pair, a_left, b_pair, b_left = c.reals("a_pair a_left b_pair b_left")
    lows_rest, rest = c.reals("lows_rest rest")
    for size in (a_left, b_left, lows_rest, rest):
        c.premise(size >= 0)
    real = (a_pair + a_left) + (b_pair + b_left)
    pair = a_pair + b_pair - lows_rest - rest
    least = c.real("least")
    left = c.use(sum_left_out, a_left, b_left, lows_rest, rest)
    enough = c.define(rounding.stands_for, pair, 0, real, least)
    c.show(c.implies(enough, left <= least))
