"""Enough, may drop and goes on mean what they say: M of N, persistence, and gaps in time."""

from cratous.core.daa.history import enough, goes_on, may_drop
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    count, m = c.integer("count"), c.integer("m")
    now, other, span = c.reals("now other span")
    c.show(c.same(c.use(enough, count, m), c.define(daa_meaning.enough, count, m)), "M of N")
    drop = c.define(daa_meaning.may_drop, now, other, span)
    c.show(c.same(c.use(may_drop, now, other, span), drop), "persistence")
    on = c.define(daa_meaning.goes_on, now, other, span)
    c.show(c.same(c.use(goes_on, now, other, span), on), "time")
