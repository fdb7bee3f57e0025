"""What happens to the certificate in hand of one vehicle, event by event, and how it stands after each: a trace.

Times are heartbeats of the trace. Trajectories have numbers of their own: 0 is flown at first.
"""

from __future__ import annotations

from typing import NamedTuple

OFFER, ARRIVES, KNOWN, ANSWER, LEFT, TIME = "offer", "arrives", "known", "answer", "left", "time"
"""The kinds of events: ICAROUS makes an offer; one that was made reaches the hand; a track becomes known; the hand is
told whether a trajectory is permitted against it; after a handback another trajectory is flown; a heartbeat passes."""
KINDS = (OFFER, ARRIVES, KNOWN, ANSWER, LEFT, TIME)


class Event(NamedTuple):
    """trajectory: that is offered, asked about or flown; begins, until: of an offer: when its manoeuvre begins, and how
    long it is permitted; permitted: of an answer."""

    kind: str
    trajectory: int = 0
    begins: int = 0
    until: int = 0
    permitted: bool = False


class InHand(NamedTuple):
    """now: the heartbeat; until: up to when what is flown is clear, as the hand says; now, if nothing is certain."""

    now: int
    until: int


class Entry(NamedTuple):
    """One event of a trace, as a user reads it, and what is in hand after it."""

    text: str
    event: Event
    after: InHand
