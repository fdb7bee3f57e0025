"""Until a vehicle is up its ICAROUS has it: it takes it at its first heartbeat, offers it to nobody, and withdraws an
offer that is open; once it is up all is as for one that started in the air."""

from cratous.core.authority.cycle import cycle_flown, cycle_watched
from cratous.core.authority.take_off import departure_lets_go, departure_step, departure_takes
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_departure
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import take_off


def claim(c: Claim) -> None:
    before, seen = any_departure(c)
    heard, now = seen[0], seen[1]
    free, foreseen = c.boolean("way_free"), c.boolean("foreseen")
    bound, least, soon = c.integer("link_bound"), c.integer("least"), c.integer("soon")
    c.premise(c.all_of(bound >= 0, least >= 0, least <= 2**56, soon >= 0))
    after = c.use(departure_step, before, *seen).departure
    cycle = any_cycle(c)
    c.premise(c.define(authority_cycle.is_mode, cycle.mode))
    departs = after.mode != take_off.UP

    steers = c.define(authority_cycle.steers, cycle)
    taken = c.use(cycle_watched, cycle, c.use(departure_takes, after, foreseen), now, soon)
    took = taken.act == authority_cycle.TAKE_OVER
    c.show(c.implies(c.all_of(departs, c.negation(steers)), took), "it is taken at once")

    lets_go = c.use(departure_lets_go, after, free)
    flown = c.use(cycle_flown, cycle, lets_go, heard, now, bound, least)
    c.show(c.implies(departs, flown.act != authority_cycle.OFFER), "nothing is offered")
    open_offer = c.all_of(departs, cycle.mode == authority_cycle.HANDBACK)
    withdrawn = c.all_of(
        flown.act == authority_cycle.WITHDRAW, flown.cycle.mode == authority_cycle.AVOID
    )
    c.show(c.implies(open_offer, withdrawn), "an offer is withdrawn")
    keeps = c.define(authority_cycle.steers, flown.cycle)
    c.show(c.implies(c.all_of(departs, steers), keeps), "it goes on flying")
    up = c.negation(departs)
    c.show(c.implies(up, c.same(lets_go, free)), "who is up goes back as anybody")
    takes = c.use(departure_takes, after, foreseen)
    c.show(c.implies(up, c.same(takes, foreseen)), "and is taken as anybody")
