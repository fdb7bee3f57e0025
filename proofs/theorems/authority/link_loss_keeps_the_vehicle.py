"""While the link is lost ICAROUS keeps the vehicle: it offers control to nobody, and withdraws an offer that is
open, until UxAS is heard again."""

from cratous.core.authority.cycle import cycle_flown
from cratous.core.authority.link_loss import loss_lets_go, loss_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_loss
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    heard, now = seen[1], seen[2]
    free, bound, least = c.boolean("way_free"), c.integer("link_bound"), c.integer("least")
    c.premise(c.all_of(bound >= 0, least >= 0, least <= 2**56))
    after = c.use(loss_step, before, *seen).loss
    cycle = any_cycle(c)
    c.premise(c.define(authority_cycle.is_mode, cycle.mode))
    lets_go = c.use(loss_lets_go, after, free)
    flown = c.use(cycle_flown, cycle, lets_go, heard, now, bound, least)
    lost = after.mode != link_loss.LINKED
    c.show(c.implies(lost, flown.act != authority_cycle.OFFER), "nothing is offered")
    open_offer = c.all_of(lost, cycle.mode == authority_cycle.HANDBACK)
    withdrawn = c.all_of(
        flown.act == authority_cycle.WITHDRAW, flown.cycle.mode == authority_cycle.AVOID
    )
    c.show(c.implies(open_offer, withdrawn), "an offer is withdrawn")
    steers = c.define(authority_cycle.steers, cycle)
    keeps = c.define(authority_cycle.steers, flown.cycle)
    c.show(c.implies(c.all_of(lost, steers), keeps), "it goes on flying")
    c.show(
        c.implies(c.negation(lost), c.same(lets_go, free)), "with the link all is as without a loss"
    )
