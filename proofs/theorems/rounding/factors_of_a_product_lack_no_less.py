"""What is counted as left out of the factors of a product can all be missing at once, so that no smaller count
would do."""

from cratous.core.readings.exact.certainty import factors_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    a_pair, a_left, b_pair, b_left, least = c.reals("a_pair a_left b_pair b_left least")
    for size in (a_pair, a_left, b_pair, b_left):
        c.premise(size >= 0)
    real = (a_pair + a_left) * (b_pair + b_left)
    left = c.use(factors_left_out, a_left, b_left, a_pair, b_pair)
    enough = c.define(rounding.stands_for, a_pair * b_pair, 0, real, least)
    c.show(c.implies(enough, left <= least))
