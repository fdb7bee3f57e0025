"""Authority does not chatter: from a takeover, and from every instant at which the way back was not free, to
the next offer at least the time passes that is asked for; and nothing is offered to a UxAS that is not
heard."""

from cratous.core.authority.cycle import cycle_flown, cycle_watched, patience
from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_times
from cratous.spec.authority import cycle as authority_cycle


def claim(c: Claim) -> None:
    cycle = any_cycle(c)
    now, soon, heard, bound, least = any_times(c)
    foreseen, free, begun = c.boolean("foreseen"), c.boolean("way_free"), c.integer("begun")
    c.premise(begun <= now)  # begun: the takeover, or the last instant at which it was not free

    taken = c.use(cycle_watched, cycle, foreseen, now, soon)
    took = taken.act == authority_cycle.TAKE_OVER
    c.show(c.implies(took, c.negation(taken.cycle.free)), "a takeover forgets the way")
    flown = c.use(cycle_flown, cycle, free, heard, now, bound, least)
    offers = flown.act == authority_cycle.OFFER
    asked = c.use(patience, cycle.relapses, least)
    since = c.implies(cycle.free, begun <= cycle.free_ms)  # after a takeover, and after each step
    kept = c.implies(flown.cycle.free, begun <= flown.cycle.free_ms)
    steers = c.define(authority_cycle.steers, cycle)
    c.show(c.implies(c.all_of(since, steers), kept), "it counts from no earlier")
    early = c.all_of(since, now < begun + asked)
    c.show(c.implies(early, c.negation(offers)), "no offer before the time has passed")
    c.show(c.implies(c.all_of(steers, c.negation(free)), c.negation(flown.cycle.free)), "a break")
    c.show(c.implies(offers, c.use(in_time, heard, now, bound)), "UxAS is heard")
