"""A bound shows that a cost is optimal exactly if no cost that is not below the bound is below that cost."""

from cratous.core.assignment.optimality import shows_optimal
from cratous.proofs.claim import Claim
from cratous.spec.assignment.bounds import none_is_cheaper


def claim(c: Claim) -> None:
    cost, bound, other = c.integer("cost"), c.integer("bound"), c.integer("other")
    optimal = c.use(shows_optimal, cost, bound)
    c.show(c.implies(optimal, c.define(none_is_cheaper, other, cost, bound)), "none is cheaper")
    # a schedule that costs what the bound is would be
    c.show(c.implies(c.define(none_is_cheaper, bound, cost, bound), optimal), "if not, one may be")
