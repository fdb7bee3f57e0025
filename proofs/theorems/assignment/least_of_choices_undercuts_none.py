"""The least of the choices so far and one more is no more than any of them, and is the most of which that
is so. One step: what the search takes for the least of many choices is made of these, one for each."""

from cratous.core.assignment.lower_bounds import least_of
from cratous.proofs.claim import Claim
from cratous.spec.assignment import bounds as assignment_bounds


def claim(c: Claim) -> None:
    x, best, value, chosen = (c.integer(name) for name in ["x", "best", "value", "chosen"])
    counts = c.boolean("counts")
    result = c.use(least_of, best, counts, value)
    wanted = c.define(assignment_bounds.undercuts_none, x, best, counts, value)
    c.show(c.same(wanted, x <= result), "it is the most that no choice undercuts")
    # the choice of a completion is among those so far, or it is this one
    c.premise(c.any_of(best <= chosen, c.all_of(counts, chosen == value)))
    c.show(result <= chosen, "the completion's choice is no less")
