"""A flight ends complete only when nothing that was asked for is left, no vehicle has anything left to
fly, UxAS commands them all and no more work is expected; it ends in every case at its limit."""

from cratous.core.executive.steps import flight_outcome
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    counts = [c.integer(n) for n in ("flying", "away", "expected", "left")]
    now, limit = c.integer("now"), c.integer("limit")
    flying, away, expected, left = counts
    c.premise(c.all_of(*[count >= 0 for count in counts]))
    how = c.use(flight_outcome, flying, away, expected, left, now, limit)
    wanted = c.define(executive.outcome, flying, away, expected, left, now, limit)
    c.show(how == wanted, "its definition")
    nothing = c.all_of(*[count == 0 for count in counts])
    c.show(c.same(how == executive.COMPLETE, nothing), "complete only with nothing left")
    idle = c.all_of(flying == 0, away == 0, expected == 0)
    c.show(c.same(how == executive.FAILED_FLIGHT, c.all_of(idle, left > 0)), "else it has failed")
    c.show(c.implies(how == executive.GOES_ON, now < limit), "it ends at its limit")
    c.show(c.implies(how == executive.LIMIT, c.negation(idle)), "and only if it is not over")
