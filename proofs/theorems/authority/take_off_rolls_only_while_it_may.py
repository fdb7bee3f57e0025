"""A vehicle rolls only at heartbeats at which its way up is permitted and UxAS is heard, and at the first at which one
is not so, and it is on the ground, the roll is broken off. It is up only after a climb, and never back in an earlier mode."""

from cratous.core.authority.take_off import departure_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_departure
from cratous.spec.authority import take_off


def claim(c: Claim) -> None:
    before, seen = any_departure(c)
    heard, now, bound, permitted, airborne, ended = seen
    after = c.use(departure_step, before, *seen).departure
    may = c.define(take_off.may, heard, now, bound, permitted)
    rolls = after.mode == take_off.ROLLING
    c.show(c.implies(rolls, may), "it rolls only where it may")
    c.show(c.implies(rolls, c.negation(airborne)), "and on the ground")
    down = c.define(take_off.is_on_ground, before.mode)
    stays = c.all_of(down, c.negation(airborne))
    stands = after.mode == take_off.STANDING
    c.show(c.implies(c.all_of(stays, c.negation(may)), stands), "else it is broken off at once")
    c.show(c.implies(c.all_of(down, airborne), after.mode == take_off.CLIMBING), "off the ground")

    climbing, up = before.mode == take_off.CLIMBING, before.mode == take_off.UP
    lower = c.define(take_off.is_on_ground, after.mode)
    c.show(c.implies(c.any_of(climbing, up), c.negation(lower)), "and never on it again")
    c.show(c.implies(up, c.same(after, before)), "who is up stays so")
    c.show(
        c.implies(after.mode == take_off.UP, c.any_of(climbing, up)), "nobody is up but by a climb"
    )
    goes_on = c.all_of(climbing, may, c.negation(ended))
    c.show(c.implies(goes_on, c.same(after, before)), "a climb that may be flown is")
    left = c.all_of(climbing, c.negation(may))
    c.show(c.implies(left, after.mode == take_off.UP), "one that may not is left at once")
