"""A span of the horizontal interval kernel with taumod that is not empty lies within [B, T]; an empty
one is from 1 to 0, and where B is after T it is empty."""

from cratous.core.well_clear import horizontal_interval_taumod
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, begin, end = c.reals("dthr tthr begin end")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    first, last = c.use(horizontal_interval_taumod, s, v, dthr, tthr, begin, end)
    within = c.all_of(begin <= first, last <= end)
    c.show(c.implies(first <= last, within), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
    c.show(c.implies(begin > end, first > last), "nothing where B is after T")
