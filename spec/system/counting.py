"""How often UxAS counts a takeover on an item, by what ICAROUS has met. Milliseconds.

ICAROUS takes over because of an intruder at most once, and once more for each permit of a way that did not last
(`spec.permit.encounter`). What UxAS counts is what it hears: a takeover, or an offer that was withdrawn before it was
taken. No part of the system keeps a `Tally`: it is what has been, since the present item began.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority.gate import State, may_command, well_formed
from cratous.spec.permit.encounter import Encounter


class Tally(NamedTuple):
    """counted: no number has grown too large to be counted on.

    Since the present item began, heard: takeovers that UxAS has counted; upsets: permits that did not last, by a surprise
    or by their end; others: takeovers because of no intruder (a zone, or the link is lost); withdrawn: offers; before:
    takeovers and withdrawals that UxAS had not heard of as it began. open: intruders that are avoided, or against which
    the way is permitted, and open_then: as the item began. made: epochs so far in which ICAROUS has commanded alone, and
    made_then: as the item began; known: of these, those up to the epoch that UxAS believes in.
    """

    counted: bool
    heard: int
    upsets: int
    others: int
    withdrawn: int
    before: int
    open: int
    open_then: int
    made: int
    made_then: int
    known: int


def alone(gate: State) -> bool:
    """ICAROUS commands, and UxAS may not."""
    return may_command(gate, 1) and not may_command(gate, 0)


def take_turns(gate: State, made: int) -> bool:
    """The gate is well formed. Epochs of ICAROUS alone, and such in which UxAS may command, take turns; of the former there have been so many."""
    now = 1 if alone(gate) else 0
    return well_formed(gate) and made >= 0 and gate.epoch + now == 2 * made


def is_open(one: Encounter) -> bool:
    """The intruder is avoided, or the way is permitted against it."""
    return one.avoiding or one.permitted


def met(tally: Tally) -> int:
    """Intruders that were met since the item began, each once, and once more for all that did not last."""
    return tally.open - tally.open_then + tally.upsets


def few(tally: Tally) -> bool:
    """UxAS counts no more takeovers than intruders were met, than permits did not last, than there were takeovers for no
    intruder and offers that were withdrawn, and than it had not heard of before."""
    unmet = tally.others + tally.withdrawn + tally.before
    return not tally.counted or tally.heard <= met(tally) + unmet
