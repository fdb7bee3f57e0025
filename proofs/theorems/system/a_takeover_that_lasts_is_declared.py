"""While a vehicle is under ICAROUS no flight is called complete, and at the limit the flight ends all the same, as one
whose time is over: a takeover that is not handed back by then is declared, however the link and the intruders are."""

from cratous.core.executive.steps import completes, flight_outcome
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    flying, away, expected = c.integer("flying"), c.integer("away"), c.integer("expected")
    left, now, limit, end = (c.integer(name) for name in ("left", "now", "limit", "end"))
    c.premise(c.all_of(flying >= 0, away >= 1, expected >= 0, left >= 0))
    how = c.use(flight_outcome, flying, away, expected, left, now, limit)
    c.show(how != executive.COMPLETE, "it is not complete")
    done = c.use(completes, how, end, limit)
    c.show(c.negation(done), "nor judged so")
    c.show(c.implies(now >= limit, how == executive.LIMIT), "at the limit it is over")
