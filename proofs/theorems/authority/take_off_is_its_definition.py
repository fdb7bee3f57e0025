"""How a vehicle leaves the ground is what its definition says, and it can be nothing else: it is in exactly one mode
at any time."""

from cratous.core.authority.take_off import (
    Departure,
    DepartureStep,
    departure_lets_go,
    departure_step,
    departure_takes,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_departure
from cratous.spec.authority import take_off


def claim(c: Claim) -> None:
    before, seen = any_departure(c)
    stepped = c.use(departure_step, before, *seen)
    c.show(c.define(take_off.is_after_heartbeat, before, *seen, stepped), "a heartbeat")
    other = DepartureStep(
        Departure(c.integer("other_mode"), c.integer("other_since")), c.integer("other_act")
    )
    told = c.define(take_off.is_after_heartbeat, before, *seen, other)
    c.show(c.implies(told, c.same(other, stepped)), "and it can be no other: never two modes")
    c.show(c.define(take_off.is_mode, stepped.departure.mode), "it is one of the four")

    reason = c.boolean("reason")
    takes = c.define(take_off.must_fly, before, reason)
    c.show(c.same(c.use(departure_takes, before, reason), takes), "why ICAROUS has the vehicle")
    goes = c.define(take_off.may_go_back, before, reason)
    c.show(c.same(c.use(departure_lets_go, before, reason), goes), "when it may go to UxAS")
