"""What a vehicle flies while UxAS is not heard is what its definition says, and it can be nothing else: it is
in exactly one mode at any time."""

from cratous.core.authority.link_loss import Loss, LossStep, loss_lets_go, loss_step, loss_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import (
    any_loss,
    any_other,
    heartbeat_as_defined,
    takes_and_goes_as_defined,
)
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    meant, other = link_loss.is_after_heartbeat, any_other(c, LossStep, Loss)
    stepped = heartbeat_as_defined(c, loss_step, meant, (before, *seen), other)
    c.show(c.define(link_loss.is_mode, stepped.loss.mode), "it is one of the eight")
    takes, goes = (loss_takes, link_loss.must_fly), (loss_lets_go, link_loss.may_go_back)
    takes_and_goes_as_defined(c, before, takes, goes, "when it may go back")
