"""Silence of more than the bound leads, at the next heartbeat of the instance, to what is chosen, or to a circle
where nothing permits that; ICAROUS takes the vehicle at that heartbeat if it does not have it."""

from cratous.core.authority.cycle import cycle_watched
from cratous.core.authority.link_loss import loss_step, loss_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_loss
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import link_loss


def claim(c: Claim) -> None:
    before, seen = any_loss(c)
    chosen, heard, now, bound, permitted, _ = seen
    period, foreseen, soon = c.integer("period"), c.boolean("foreseen"), c.integer("soon")
    c.premise(c.all_of(period >= 0, soon >= 0, before.mode == link_loss.LINKED))
    # the heartbeat before this one was at most a period ago, and the silence was not too long then
    c.premise(now - period <= heard + bound)
    silent = now > heard + bound
    after = c.use(loss_step, before, *seen).loss
    at_once = c.all_of(after.since_ms == now, after.since_ms <= heard + bound + period)
    c.show(c.implies(silent, at_once), "within a heartbeat")
    c.show(c.implies(c.all_of(silent, permitted), after.mode == chosen), "what is chosen")
    circle = after.mode == link_loss.LOITER
    c.show(c.implies(c.all_of(silent, c.negation(permitted)), circle), "else a circle")
    begins = c.all_of(silent, after.mode != link_loss.LINKED)
    c.show(c.implies(silent, begins), "the link counts as lost")

    cycle = any_cycle(c)
    watches = c.negation(c.define(authority_cycle.steers, cycle))
    taken = c.use(cycle_watched, cycle, c.use(loss_takes, after, foreseen), now, soon)
    took = taken.act == authority_cycle.TAKE_OVER
    c.show(c.implies(c.all_of(silent, watches), took), "and the vehicle is taken over")
