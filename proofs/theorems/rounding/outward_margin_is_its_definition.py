"""The outward margin is a share of a value's magnitude and what underflow may take, for every value,
share and least."""

from cratous.core.readings.exact.certainty import outward_margin
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    value, share, least = c.reals("value share least")
    margin = c.use(outward_margin, value, share, least)
    c.show(c.same(margin, c.define(rounding.outward_margin, value, share, least)))
