"""What happens to authority over one vehicle, event by event, and how things stand after each: a trace."""

from __future__ import annotations

from typing import NamedTuple

HEARTBEAT, REPORT, MODE, TRACK, COMMAND, RESTART = (
    "heartbeat",
    "report",
    "mode",
    "track",
    "command",
    "restart",
)
"""The kinds of events: a heartbeat of ICAROUS; a report of the gate reaches UxAS; a SETMOD line does; UxAS
has a new track to fly; a command reaches the gate; the gate starts anew."""
KINDS = (HEARTBEAT, REPORT, MODE, TRACK, COMMAND, RESTART)
NOTHING = -1
"""In the place of the epoch of a command that UxAS sends."""


class Event(NamedTuple):
    """flag: of a heartbeat: the way is free; of a report: control is offered; of a line: ICAROUS commands.

    who: of a report: the owner; of a command: the sender (0 UxAS, 1 ICAROUS); epoch: of a report, line or
    command; changes: of a command: how many epochs had begun when it was made.
    """

    kind: str
    flag: bool = False
    who: int = 0
    epoch: int = 0
    changes: int = 0


class Standing(NamedTuple):
    """owner, epoch, offered: of the gate; mode: of ICAROUS (`spec.authority.cycle`); active, heard: what UxAS
    believes, and since which epoch; suspended: its own flying is.

    accepted: whether the command of this event has reached the actuators; sent: the epoch of a command of
    UxAS that this event has led to, or NOTHING.
    """

    owner: int
    epoch: int
    offered: bool
    mode: int
    active: bool
    heard: int
    suspended: bool
    accepted: bool
    sent: int


class Entry(NamedTuple):
    """One event of a trace, as a user reads it, and how things stand after it."""

    text: str
    event: Event
    after: Standing
