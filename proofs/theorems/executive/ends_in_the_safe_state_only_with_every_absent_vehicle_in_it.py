"""A flight ends in the declared safe state only while a vehicle is under ICAROUS, every such vehicle is in that state,
no other has anything left to fly and no more work is expected; no flight that ends so is complete."""

from cratous.core.executive.steps import completes, ends_in_safe_state, flight_outcome
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    working, away, safe, expected = (c.integer(n) for n in ("working", "away", "safe", "expected"))
    flying, left, now = c.integer("flying"), c.integer("left"), c.integer("now")
    limit, end = c.integer("limit"), c.integer("end")
    counts = c.all_of(working >= 0, safe >= 0, away >= safe, expected >= 0, flying >= 0, left >= 0)
    c.premise(counts)
    ends = c.use(ends_in_safe_state, working, away, safe, expected)
    c.show(c.define(executive.is_safe_end, working, away, safe, expected, ends), "its definition")
    nobody_else = c.all_of(working == 0, away == safe, expected == 0)
    c.show(c.same(ends, c.all_of(nobody_else, safe >= 1)), "with every absent vehicle in it")
    how = c.use(flight_outcome, flying, away, expected, left, now, limit)
    c.show(c.implies(ends, how != executive.COMPLETE), "it is not complete")
    done = c.use(completes, how, end, limit)
    c.show(c.implies(ends, c.negation(done)), "nor judged so")
