"""Arbitrary values for theorems on one vehicle and one zone: its gate, its certificate in hand, the true situation."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.cycle import gate_wished
from cratous.core.authority.gate import Gate, gate_accepts, gate_after
from cratous.core.permit.hand import Hand, hand_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import (
    HandEvent,
    any_hand,
    any_hand_event,
    each_hand_event,
    in_hand_after,
)
from cratous.proofs.methods.happenings import COMMAND, HEARTBEAT, Asked
from cratous.proofs.methods.vehicles import counts
from cratous.spec.system import fenced as system


class Fencing(NamedTuple):
    """A vehicle: its gate, its hand, and the true situation regarding one zone (`spec.system.fenced`)."""

    gate: Gate
    hand: Hand
    known: system.Fenced


class Turn(NamedTuple):
    """An event. kind: as in `happenings`; act: the change of authority by ICAROUS at a heartbeat; sender, epoch: of a
    command that reaches the gate; way: what UxAS commands, if it is the sender; of_hand: an event of the hand."""

    kind: Any
    now: Any
    act: Any
    sender: Any
    epoch: Any
    way: system.Way
    of_hand: HandEvent


def any_way(c: Claim, name: str) -> system.Way:
    """An arbitrary command of UxAS."""
    return system.Way(*[c.boolean(f"{name}_{part}") for part in ("kept", "near", "obeys")])


def any_turn(c: Claim) -> Turn:
    """An arbitrary event."""
    now = c.whole("now")
    act, sender, epoch = (c.whole(name) for name in ("act", "sender", "command_epoch"))
    way, of_hand = any_way(c, "wanted"), any_hand_event(c, now)
    return Turn(c.whole("happens"), now, act, sender, epoch, way, of_hand)


def each_turn(c: Claim, one: Turn, asked: Asked) -> Any:
    """Condition on every event: numbers are within counting range, and what was checked or permitted is so."""
    return c.all_of(
        *[counts(c, number) for number in (one.act, one.sender, one.epoch)],
        c.define(system.checked, one.way),
        each_hand_event(c, one.of_hand, asked.known_as, asked.at),
    )


def no_fencing() -> Fencing:
    """The initial state: UxAS may command and has commanded nothing, nothing is in hand."""
    nothing = system.Way(False, False, False)
    return Fencing(
        Gate(0, 0, False), Hand(0, 0, 0, 0), system.Fenced(True, True, 0, nothing, False)
    )


def any_fencing(c: Claim) -> Fencing:
    """An arbitrary vehicle, with numbers of any size."""
    gate = Gate(c.whole("owner"), c.whole("gate_epoch"), c.boolean("offered"))
    known = system.Fenced(
        c.boolean("counted"), c.boolean("in_order"), c.whole("then"), any_way(c, "flown"),
        c.boolean("in_hand"),
    )  # fmt: skip
    return Fencing(gate, any_hand(c), known)


def after_turn(c: Claim, one: Fencing, what: Turn, asked: Asked) -> Fencing:
    """The vehicle after an event, by the kernels that fly. Once a number is out of counting range nothing more is
    claimed."""
    (owner, era, offered), hand, known = one
    numbers = (owner, era, *hand, known.now_ms)
    counted = c.all_of(known.counted, *[counts(c, number) for number in numbers])
    owner, era, *held = (c.when(counts(c, number), number, 0) for number in numbers)
    gate, hand = Gate(owner, era, offered), Hand(*held[:4])
    beats, commands = what.kind == HEARTBEAT, what.kind == COMMAND
    other, event = c.negation(c.any_of(beats, commands)), what.of_hand
    passes = c.use(gate_accepts, gate, what.sender, what.epoch)
    taken = c.all_of(commands, what.sender == 0, passes)
    wished = c.use(gate_wished, gate, what.act)
    told = c.use(gate_after, gate, what.sender, what.epoch)
    kept = c.use(hand_step, hand, event.kind, event.offer, event.permitted, what.now, asked.reserve)
    truth = in_hand_after(c, hand, known.hand, event, asked)
    return Fencing(
        c.when(beats, wished, c.when(commands, told, gate)),
        c.when(other, kept, hand),
        system.Fenced(
            counted,
            c.all_of(known.in_order, what.now >= known.now_ms),
            what.now,
            c.when(taken, what.way, known.way),
            c.when(other, truth, known.hand),
        ),
    )
