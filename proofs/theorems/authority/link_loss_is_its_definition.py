"""What a vehicle flies while UxAS is not heard is what its definition says, and it can be nothing else: it is
in exactly one mode at any time."""

from cratous.core.authority.link_loss import Loss, LossStep, loss_lets_go, loss_step, loss_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_loss
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    stepped = c.use(loss_step, before, *seen)
    c.show(c.define(link_loss.is_after_heartbeat, before, *seen, stepped), "a heartbeat")
    other = LossStep(
        Loss(c.integer("other_mode"), c.integer("other_since")), c.integer("other_act")
    )
    may = c.define(link_loss.is_after_heartbeat, before, *seen, other)
    c.show(c.implies(may, c.same(other, stepped)), "and it can be no other: never two modes")
    c.show(c.define(link_loss.is_mode, stepped.loss.mode), "it is one of the eight")

    reason = c.boolean("reason")
    takes = c.define(link_loss.must_fly, before, reason)
    c.show(c.same(c.use(loss_takes, before, reason), takes), "why ICAROUS has the vehicle")
    goes = c.define(link_loss.may_go_back, before, reason)
    c.show(c.same(c.use(loss_lets_go, before, reason), goes), "when it may go back")
