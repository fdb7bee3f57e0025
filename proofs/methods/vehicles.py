"""Arbitrary values for theorems on one vehicle as a whole: gate, ICAROUS, certificate in hand, true situation."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.gate import Gate
from cratous.core.permit.encounter import Encounter
from cratous.core.permit.hand import Hand
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import MOST, any_hand
from cratous.spec.system import clear as system


class Vehicle(NamedTuple):
    """One vehicle, its encounter with one intruder, and the true situation (`spec.system.clear`)."""

    gate: Gate
    cycle: Cycle
    met: Encounter
    hand: Hand
    sure: system.Sure


def numbers_of(one: Vehicle) -> tuple[Any, ...]:
    """All counters and times of a vehicle."""
    gate, cycle, met, hand, sure = one
    counted = (met.takeovers, met.surprises, met.ended, met.expiry_ms)
    times = (cycle.mode, cycle.relapses, cycle.handed_ms, cycle.free_ms)
    return (gate.owner, gate.epoch, *times, *counted, *hand, sure.now_ms, sure.until_ms)


def within_range(c: Claim, one: Vehicle) -> Vehicle:
    """The vehicle with 0 in place of each number that is out of counting range."""
    gate, cycle, met, hand, sure = one

    def small(number: Any) -> Any:
        return c.when(counts(c, number), number, 0)

    return Vehicle(
        Gate(small(gate.owner), small(gate.epoch), gate.offered),
        Cycle(
            small(cycle.mode), small(cycle.relapses), cycle.handed, small(cycle.handed_ms),
            cycle.free, small(cycle.free_ms),
        ),
        Encounter(
            small(met.takeovers), small(met.surprises), small(met.ended),
            met.avoiding, met.permitted, small(met.expiry_ms),
        ),
        Hand(*map(small, hand)),
        sure._replace(now_ms=small(sure.now_ms), until_ms=small(sure.until_ms)),
    )  # fmt: skip


def counts(c: Claim, number: Any) -> Any:
    """Whether a number is within counting range, so that counting on from it does not overflow."""
    return c.all_of(number >= -MOST, number <= MOST)


def first_vehicle() -> Vehicle:
    """The initial state: UxAS commands, nothing has happened, nothing is in hand."""
    return Vehicle(
        Gate(0, 0, False),
        Cycle(0, 0, False, 0, False, 0),
        Encounter(0, 0, 0, False, False, 0),
        Hand(0, 0, 0, 0),
        system.Sure(True, True, 0, False, False, False, 0, False),
    )


def any_vehicle(c: Claim) -> Vehicle:
    """An arbitrary vehicle, with numbers of any size."""
    gate = Gate(c.whole("owner"), c.whole("gate_epoch"), c.boolean("offered"))
    cycle = Cycle(
        c.whole("mode"), c.whole("relapses"), c.boolean("handed"), c.whole("handed_ms"),
        c.boolean("free"), c.whole("free_ms"),
    )  # fmt: skip
    met = Encounter(
        c.whole("takeovers"), c.whole("surprises"), c.whole("ended"),
        c.boolean("avoiding"), c.boolean("met_permitted"), c.whole("met_until"),
    )  # fmt: skip
    sure = system.Sure(
        c.boolean("counted"), c.boolean("in_order"), c.whole("then"), c.boolean("looked"),
        c.boolean("way"), c.boolean("permit"), c.whole("until"), c.boolean("in_hand"),
    )  # fmt: skip
    return Vehicle(gate, cycle, met, any_hand(c), sure)
