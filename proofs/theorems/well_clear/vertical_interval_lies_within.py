"""A span of the vertical interval kernel that is not empty lies within [B, T]; an empty one is from 1
to 0, and where B is after T it is empty."""

from cratous.core.well_clear import vertical_interval
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, begin, end = c.reals("sz vz zthr tcoa vmod begin end")
    for threshold in (zthr, tcoa, vmod):
        c.premise(threshold >= 0)
    first, last = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    within = c.all_of(begin <= first, last <= end)
    c.show(c.implies(first <= last, within), "within [B, T]")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
    c.show(c.implies(begin > end, first > last), "nothing where B is after T")
