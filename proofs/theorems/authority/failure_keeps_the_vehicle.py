"""A declared failure stays. From the heartbeat at which it is declared, whatever is heard of UxAS, the vehicle flies what
the mission chooses for it if that is permitted, a circle if it is not, or what follows from these; ICAROUS has to have the
vehicle, takes it if it does not, and does not let it go."""

from cratous.core.authority.cycle import cycle_watched
from cratous.core.authority.failure import failure_step, heard_by, loss_declared
from cratous.core.authority.link_loss import Loss, loss_lets_go, loss_step, loss_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_failure
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import failure, link_loss


def claim(c: Claim) -> None:
    before, seen = any_failure(c)
    mode, now = seen[2], seen[3]
    after = c.use(failure_step, before, *seen)
    declared = after.kind != failure.NONE
    was = before.kind != failure.NONE
    c.show(c.implies(was, c.same(after, before)), "it stays")
    committed = c.define(link_loss.is_committed, mode)
    fresh = c.all_of(declared, c.negation(was))
    c.show(c.implies(fresh, c.negation(committed)), "none is declared in the final descent")
    c.show(c.implies(fresh, after.since_ms == now), "it is declared now")

    heard, bound, chosen = c.integer("heard"), c.integer("silence"), c.integer("chosen")
    permitted, ended = c.boolean("permitted"), c.boolean("ended")
    loss = Loss(mode, c.integer("loss_since"))
    c.premise(c.define(link_loss.is_mode, mode))
    c.premise(c.define(link_loss.may_be_chosen, chosen))
    c.premise(c.all_of(bound >= 0, bound <= 2**56, now >= 0, heard >= 0, heard <= now))
    begun = c.use(loss_declared, before, after, loss)
    by = c.use(heard_by, after, heard)
    flown = c.use(loss_step, begun, chosen, by, now, bound, permitted, ended).loss
    linked = flown.mode == link_loss.LINKED
    c.show(c.implies(declared, c.negation(linked)), "the vehicle flies by itself")
    begins = c.all_of(fresh, permitted)
    c.show(c.implies(begins, flown.mode == chosen), "what is chosen begins at once")
    waits = c.all_of(fresh, c.negation(permitted))
    c.show(c.implies(waits, flown.mode == link_loss.LOITER), "else a circle")

    foreseen, free, soon = c.boolean("foreseen"), c.boolean("way_free"), c.integer("soon")
    c.premise(soon >= 0)
    takes = c.use(loss_takes, flown, foreseen)
    c.show(c.implies(declared, takes), "ICAROUS has to have it")
    c.show(c.implies(declared, c.negation(c.use(loss_lets_go, flown, free))), "and keeps it")
    cycle = any_cycle(c)
    watches = c.negation(c.define(authority_cycle.steers, cycle))
    taken = c.use(cycle_watched, cycle, takes, now, soon)
    took = taken.act == authority_cycle.TAKE_OVER
    c.show(c.implies(c.all_of(declared, watches), took), "and takes it if it does not have it")
