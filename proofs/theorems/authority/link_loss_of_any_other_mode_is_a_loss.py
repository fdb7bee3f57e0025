"""Whatever number stands for what a vehicle flies while UxAS is not heard: only the one of a link that is there lets the
vehicle go back, and with any other ICAROUS has to have it, be a conflict foreseen or not."""

from cratous.core.authority.link_loss import Loss, loss_lets_go, loss_takes
from cratous.proofs.claim import Claim
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    loss = Loss(c.integer("mode"), c.integer("since_ms"))
    free, foreseen = c.boolean("way_free"), c.boolean("foreseen")
    goes, takes = c.use(loss_lets_go, loss, free), c.use(loss_takes, loss, foreseen)
    linked = loss.mode == link_loss.LINKED
    c.show(c.same(goes, c.all_of(free, linked)), "who lets go")
    c.show(c.same(takes, c.any_of(foreseen, c.negation(linked))), "who takes")
    c.show(c.implies(c.negation(linked), c.all_of(takes, c.negation(goes))), "a loss keeps it")
