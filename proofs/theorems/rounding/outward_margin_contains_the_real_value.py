"""The result of one operation on doubles, moved down and up by the outward margin, both computed
on doubles themselves, encloses the real result, underflow included."""

from fractions import Fraction

from cratous.core.readings.enclosed import LEAST, SHARE
from cratous.core.readings.exact.certainty import outward_margin
from cratous.core.readings.exact.error_bounds import TINY, UNIT
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    value, real, share, margin, low, high = c.reals("value real share margin low high")
    unit, tiny = UNIT, TINY
    c.premise(value >= 0)
    c.premise(c.define(rounding.rounded, value, real, unit, tiny))
    c.premise(c.define(rounding.rounded, share, value * Fraction(SHARE), unit, tiny))
    c.premise(c.define(rounding.rounded, margin, share + Fraction(LEAST), unit, 0))
    c.premise(c.define(rounding.rounded, low, value - margin, unit, 0))
    c.premise(c.define(rounding.rounded, high, value + margin, unit, 0))
    wanted = c.define(rounding.outward_margin, value, Fraction(SHARE), Fraction(LEAST))
    ours = c.use(outward_margin, value, Fraction(SHARE), Fraction(LEAST))
    c.show(c.same(ours, wanted), "the margin, not below zero")
    below = c.use(outward_margin, -value, Fraction(SHARE), Fraction(LEAST))
    c.show(c.same(below, wanted), "the margin, below zero")
    c.show(c.define(rounding.between, low, real, high), "the enclosure")
    c.show(c.define(rounding.between, -high, -real, -low), "the enclosure below zero")
