"""A trace of the certificate in hand of one vehicle: events, and its state after each.

Times are heartbeats of the trace. Trajectories are numbered; 0 is flown at first.
"""

from __future__ import annotations

from typing import NamedTuple

OFFER, ARRIVES, KNOWN, ANSWER, LEFT, TIME = "offer", "arrives", "known", "answer", "left", "time"
"""The kinds of events: ICAROUS makes an offer; an offer reaches the hand; a track becomes known; the hand is told
whether a trajectory is permitted against it; after a handback another trajectory is flown; a heartbeat passes.
"""
KINDS = (OFFER, ARRIVES, KNOWN, ANSWER, LEFT, TIME)


class Event(NamedTuple):
    """trajectory: the one offered, asked about or flown; begins, until: of an offer: when its manoeuvre begins, and
    until when it is permitted; permitted: of an answer.
    """

    kind: str
    trajectory: int = 0
    begins: int = 0
    until: int = 0
    permitted: bool = False


class InHand(NamedTuple):
    """now: the heartbeat; until: the time up to which what is flown is clear, by the certificate in hand; `now` if
    nothing is guaranteed.
    """

    now: int
    until: int


class Entry(NamedTuple):
    """One event of a trace, as a user reads it, and the certificate in hand after it."""

    text: str
    event: Event
    after: InHand
