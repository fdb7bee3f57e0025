"""How often UxAS counts a takeover on an item, given the intruders that ICAROUS has met. Milliseconds.

ICAROUS takes over because of an intruder at most once, and once more for each permit of a path that did not last
(`spec.permit.encounter`). UxAS counts what it hears: a takeover, or an offer that was withdrawn before it was taken.
No component of the system stores a `Tally`: it records what has happened since the present item began.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority.gate import State, may_command, well_formed
from cratous.spec.permit.encounter import Encounter


class Tally(NamedTuple):
    """counted: no counter has overflowed its limit.

    Since the present item began, heard: takeovers that UxAS has counted; upsets: permits that did not last, by a
    surprise or by their end; others: takeovers not caused by an intruder (a zone, or link loss); withdrawn: offers;
    before: takeovers and withdrawals that UxAS had not heard of when it began. open: intruders that are being
    avoided, or against which the path is permitted, and open_then: when the item began. made: epochs so far in which
    ICAROUS has commanded alone, and made_then: when the item began; known: of these, those up to the epoch that UxAS
    believes in.
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
    """The gate is well formed. Epochs in which ICAROUS alone commands alternate with epochs in which UxAS may
    command; `made` is the number of the former so far.
    """
    now = 1 if alone(gate) else 0
    return well_formed(gate) and made >= 0 and gate.epoch + now == 2 * made


def is_open(one: Encounter) -> bool:
    """The intruder is being avoided, or the path is permitted against it."""
    return one.avoiding or one.permitted


def met(tally: Tally) -> int:
    """Intruders met since the item began, each counted once, and once more for each permit that did not last."""
    return tally.open - tally.open_then + tally.upsets


def few(tally: Tally) -> bool:
    """The takeovers that UxAS counts are at most the sum of the intruders met, the permits that did not last, the
    takeovers not caused by an intruder, the offers withdrawn, and those it had not heard of before.
    """
    unmet = tally.others + tally.withdrawn + tally.before
    return not tally.counted or tally.heard <= met(tally) + unmet
