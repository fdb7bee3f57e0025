"""A span that holds no instant is always the same one, from 1 to 0; any other is what it is given."""

from cratous.core.well_clear import or_empty
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    first, last, t = c.reals("first last t")
    span = c.use(or_empty, first, last)
    inside = c.define(well_clear.in_span, first, last, t)
    c.show(c.same(c.define(well_clear.in_span, *span, t), inside), "the same instants")
    empty = c.all_of(span.first_s == 1, span.last_s == 0)
    c.show(c.implies(first > last, empty), "one empty span")
    given = c.all_of(span.first_s == first, span.last_s == last)
    c.show(c.implies(first <= last, given), "otherwise as given")
