"""A trace of authority over one vehicle: events, and the state after each."""

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
"""The kinds of events: a heartbeat of ICAROUS; a gate report reaches UxAS; a SETMOD line reaches UxAS; UxAS has a new
track to fly; a command reaches the gate; the gate restarts.
"""
KINDS = (HEARTBEAT, REPORT, MODE, TRACK, COMMAND, RESTART)
NOTHING = -1
"""Stands for the epoch of a command when UxAS sends none."""


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
    believes, and since which epoch; suspended: whether its own flying is.

    accepted: whether the command of this event has reached the actuators; sent: the epoch of a UxAS command caused by
    this event, or NOTHING.
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
    """One event of a trace, as a user reads it, and the state after it."""

    text: str
    event: Event
    after: Standing
