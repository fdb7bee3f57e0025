"""The hull of two spans holds every instant of either of them."""

from cratous.core.daa.uncertainty import span_hull
from cratous.core.well_clear.interval import Span
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    first, last, begin, end, t = c.reals("first last begin end t")
    hull = c.use(span_hull, Span(first, last), Span(begin, end))
    either = c.define(daa_meaning.in_either, first, last, begin, end, t)
    c.show(c.implies(either, c.define(well_clear.in_span, *hull, t)), "holds both")
    for time in (1, 3):
        c.show(c.define(daa_meaning.in_either, 0, 1, 2, 3, time), "examples: in one of both")
    c.show(
        c.implies(
            c.all_of(first <= last, begin <= end),
            c.all_of(
                c.any_of(hull.first_s == first, hull.first_s == begin),
                c.any_of(hull.last_s == last, hull.last_s == end),
            ),
        ),
        "no more than needed",
    )
