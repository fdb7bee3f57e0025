"""A volume is looked for until the alerting time after the manoeuvre, or in all if the manoeuvre is
counted, and never beyond the look-ahead; a longer look-ahead never shortens it."""

from cratous.core.daa.steps import until
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    lookahead, time, manoeuvre, more = c.reals("lookahead time manoeuvre more")
    counted = c.boolean("counted")
    c.premise(manoeuvre >= 0)
    c.premise(more >= 0)
    end = c.use(until, lookahead, time, manoeuvre, counted)
    c.show(c.define(daa_meaning.horizon, end, lookahead, time, manoeuvre, counted))
    c.show(end <= c.use(until, lookahead + more, time, manoeuvre, counted), "monotone")
    c.show(c.use(until, lookahead, time, manoeuvre, True) <= end, "counting only shortens")
