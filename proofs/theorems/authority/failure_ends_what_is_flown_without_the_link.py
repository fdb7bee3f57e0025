"""Without the link its procedure is flown until a failure is declared: the loss of the link declares none as long as
certificates are found for what is flown. From a declared failure on the procedure for that is flown, if it is permitted at
once, whether UxAS is heard or not; the one without the link is never flown again."""

from cratous.core.authority.failure import failure_step, heard_by, loss_declared, procedure
from cratous.core.authority.link_loss import Loss, loss_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_failure
from cratous.spec.authority import failure, link_loss


def claim(c: Claim) -> None:
    before, seen = any_failure(c)
    _, observed, mode, now, _ = seen
    after = c.use(failure_step, before, *seen)
    alone, failed = c.integer("without_link"), c.integer("after_failure")
    chosen = c.use(procedure, after, alone, failed)
    c.show(c.define(failure.is_procedure, after, alone, failed, chosen), "the procedure")
    other = c.integer("other_procedure")
    another = c.define(failure.is_procedure, after, alone, failed, other)
    c.show(c.implies(another, other == chosen), "and it can be no other")

    declared, was = after.kind != failure.NONE, before.kind != failure.NONE
    no_cause = c.all_of(c.negation(was), c.negation(observed.stopped), c.negation(observed.without))
    c.show(c.implies(no_cause, c.same(after, before)), "the link alone declares no failure")
    c.show(c.implies(no_cause, chosen == alone), "and its procedure is flown")
    c.show(c.implies(declared, chosen == failed), "after a failure the one for that")
    c.show(c.implies(was, c.use(procedure, after, alone, failed) == failed), "for good")

    heard, bound = c.integer("heard"), c.integer("silence")
    permitted, ended = c.boolean("permitted"), c.boolean("ended")
    loss = Loss(mode, c.integer("loss_since"))
    c.premise(c.define(link_loss.is_mode, mode))
    c.premise(
        c.all_of(
            c.define(link_loss.may_be_chosen, alone), c.define(link_loss.may_be_chosen, failed)
        )
    )
    c.premise(c.all_of(bound >= 0, bound <= 2**56, now >= 0, heard >= 0, heard <= now))
    begun = c.use(loss_declared, before, after, loss)
    by = c.use(heard_by, after, heard)
    flown = c.use(loss_step, begun, chosen, by, now, bound, permitted, ended).loss
    fresh = c.all_of(declared, c.negation(was))
    at_once = c.all_of(fresh, permitted)
    c.show(c.implies(at_once, flown.mode == failed), "it begins at once, whatever was flown")
