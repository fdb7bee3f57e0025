"""Which failure is declared is what its definition says, and it can be no other; what counts as heard, and what is begun
anew, likewise."""

from cratous.core.authority.failure import Failure, failure_step, heard_by, loss_declared
from cratous.core.authority.link_loss import Loss
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_failure
from cratous.spec.authority import failure as meant


def claim(c: Claim) -> None:
    before, seen = any_failure(c)
    after = c.use(failure_step, before, *seen)
    c.show(c.define(meant.is_after_heartbeat, before, *seen, after), "a heartbeat")
    other = Failure(c.integer("other_kind"), c.integer("other_since"))
    another = c.define(meant.is_after_heartbeat, before, *seen, other)
    c.show(c.implies(another, c.same(other, after)), "and it can be no other")
    c.show(c.define(meant.is_kind, after.kind), "it is none, or one of the four")

    heard = c.integer("heard")
    by = c.use(heard_by, before, heard)
    c.show(c.define(meant.is_heard_by, before, heard, by), "what counts as heard")
    loss = Loss(c.integer("mode_without"), c.integer("loss_since"))
    begun = c.use(loss_declared, before, after, loss)
    c.show(c.define(meant.is_begun_anew, before, after, loss, begun), "what begins anew")
