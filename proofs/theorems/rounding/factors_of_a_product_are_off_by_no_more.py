"""The product of two pairs of doubles stands for the product of the two real numbers that the pairs stand
for, within what is counted as left out of the factors."""

from cratous.core.readings.exact.certainty import factors_left_out
from cratous.proofs.claim import Claim
from cratous.spec import rounding

SIZE = "rounding_size_of_a_product_is_bounded"


def claim(c: Claim) -> None:
    a, a_pair, a_left, a_size = c.reals("a a_pair a_left a_size")
    b, b_pair, b_left, b_size = c.reals("b b_pair b_left b_size")
    c.premise(c.define(rounding.stands_for, a_pair, 0, a, a_left))
    c.premise(c.define(rounding.stands_for, b_pair, 0, b, b_left))
    c.premise(c.define(rounding.near, a_pair, a_pair, a_size, 0))
    c.premise(c.define(rounding.near, b_pair, b_pair, b_size, 0))
    c.lemma(SIZE, x=a - a_pair, most_x=a_left, y=b_pair, most_y=b_size)
    c.lemma(SIZE, x=a - a_pair, most_x=a_left, y=b - b_pair, most_y=b_left)
    c.lemma(SIZE, x=a_pair, most_x=a_size, y=b - b_pair, most_y=b_left)
    left = c.use(factors_left_out, a_left, b_left, a_size, b_size)
    c.show(c.define(rounding.stands_for, a_pair * b_pair, 0, a * b, left))
