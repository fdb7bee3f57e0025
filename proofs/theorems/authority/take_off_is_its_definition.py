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
from cratous.proofs.methods.command import (
    any_departure,
    any_other,
    heartbeat_as_defined,
    takes_and_goes_as_defined,
)
from cratous.spec.authority import take_off


def claim(c: Claim) -> None:
    before, seen = any_departure(c)
    meant, other = take_off.is_after_heartbeat, any_other(c, DepartureStep, Departure)
    stepped = heartbeat_as_defined(c, departure_step, meant, (before, *seen), other)
    c.show(c.define(take_off.is_mode, stepped.departure.mode), "it is one of the four")
    takes, goes = (departure_takes, take_off.must_fly), (departure_lets_go, take_off.may_go_back)
    takes_and_goes_as_defined(c, before, takes, goes, "when it may go to UxAS")
