"""A predicted loss is a conflict exactly when no more than the alerting time is left; one that is there
stays one for at least as long as one that is not, so answers do not flicker, and a nearer loss is
never less of a conflict."""

from cratous.core.contracts.responses import loss_is_soon
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    first, limit, early, nearer = c.reals("first limit early nearer")
    answering = c.boolean("answering")
    soon = c.use(loss_is_soon, first, limit, early, answering)
    c.show(c.same(soon, c.define(responses.soon, first, limit, early, answering)), "its definition")
    fresh = c.use(loss_is_soon, first, limit, early, False)
    c.show(c.implies(fresh, soon), "what is there stays")
    near = c.use(loss_is_soon, nearer, limit, early, answering)
    c.show(c.implies(c.all_of(soon, nearer <= first), near), "nearer is no less")
