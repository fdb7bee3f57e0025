"""A lead time counts iff it lies between now and its threshold, both included: such leads are the
instants of the span from 0 to the threshold."""

from cratous.core.well_clear import or_empty
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    lead, limit = c.reals("lead limit")
    span = c.use(or_empty, lead - lead, limit)
    soon = c.define(well_clear.soon, lead, limit)
    c.show(c.same(soon, c.define(well_clear.in_span, *span, lead)), "the same instants")
