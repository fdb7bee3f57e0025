"""Arbitrary events for theorems on a vehicle as a whole, and its state after one."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.gate import gate_after
from cratous.core.permit.hand import hand_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.beats import (
    Around,
    Beat,
    any_beat,
    any_surroundings,
    beaten,
    each_beat,
)
from cratous.proofs.methods.hands import (
    MOST,
    HandEvent,
    any_hand_event,
    each_hand_event,
    in_hand_after,
)
from cratous.proofs.methods.vehicles import Vehicle, counts, numbers_of, within_range
from cratous.spec.system import clear as system

HEARTBEAT, COMMAND = 0, 1
"""Kinds of events; any other number is an event of the hand."""


class Happening(NamedTuple):
    """kind: a heartbeat of its ICAROUS, a command of a sender in an epoch that reaches its gate, or an event of the
    hand; now: [ms]."""

    kind: Any
    now: Any
    sender: Any
    epoch: Any
    beat: Beat
    around: Around
    of_hand: HandEvent


class Asked(NamedTuple):
    """reserve: of the hand [ms]; known_as: number of the knowledge change by which the obstacle became known; at: the
    instant considered [ms]."""

    reserve: Any
    known_as: Any
    at: Any


def any_happening(c: Claim) -> Happening:
    """An arbitrary event."""
    now = c.whole("now")
    said = (c.whole("happens"), now, c.whole("sender"), c.whole("command_epoch"))
    return Happening(*said, any_beat(c), any_surroundings(c), any_hand_event(c, now))


def each_happening(c: Claim, one: Happening, asked: Asked) -> Any:
    """Condition on every event: numbers are within counting range, and predictions and permits are correct."""
    return c.all_of(
        *[c.all_of(n >= -MOST, n <= MOST) for n in (one.sender, one.epoch)],
        each_beat(c, one.beat, one.around, one.now, asked.at),
        each_hand_event(c, one.of_hand, asked.known_as, asked.at),
    )


def after_happening(c: Claim, one: Vehicle, what: Happening, asked: Asked) -> Vehicle:
    """The vehicle after an event, by the kernels that fly. Once a number is out of counting range nothing more is
    claimed."""
    counted = c.all_of(one.sure.counted, *[counts(c, n) for n in numbers_of(one)])
    gate, cycle, met, hand, sure = within_range(c, one)
    now, event = what.now, what.of_hand
    there = sure._replace(now_ms=now)
    after = beaten(c, (gate, cycle, met), there, what.beat, what.around, asked.at)
    beats, commands = what.kind == HEARTBEAT, what.kind == COMMAND
    other = c.negation(c.any_of(beats, commands))
    stands = c.use(gate_after, gate, what.sender, what.epoch)
    given = (event.kind, event.offer, event.permitted, now, asked.reserve)
    held = c.use(hand_step, hand, *given)
    truth = in_hand_after(c, hand, sure.hand, event, asked)
    return Vehicle(
        c.when(beats, after.gate, c.when(commands, stands, gate)),
        c.when(beats, after.cycle, cycle),
        c.when(beats, after.met, met),
        c.when(other, held, hand),
        system.Sure(
            counted,
            c.all_of(sure.in_order, now >= sure.now_ms),
            now,
            c.when(beats, after.looked, sure.looked),
            c.when(beats, after.way, sure.way),
            c.when(beats, after.permit, sure.permit),
            c.when(beats, after.until_ms, sure.until_ms),
            c.when(other, truth, sure.hand),
        ),
    )
