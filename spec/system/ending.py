"""That things end: takeovers, silence, missions. Each measure here falls and cannot fall for ever. Milliseconds."""

from __future__ import annotations

from cratous.spec import executive
from cratous.spec.authority import gate as authority

MOST_PATIENCE = 16
"""The way back never has to be free for longer than this many times the least time."""


def over(now: int, begun: int, most: int) -> bool:
    """What began then has lasted for at least this long."""
    return not now < begun + most


def handed_back(gate: authority.State) -> bool:
    """UxAS alone commands."""
    return authority.may_command(gate, 0) and not authority.may_command(gate, 1)


def task_steps_left(life: int) -> int:
    """How many more changes a task can go through: it may begin, and it may end or fail."""
    if executive.settled(life):
        return 0
    if life == executive.LEFT:
        return 2
    return 1


def legs_left(items: int, phase: int) -> int:
    """How many legs a chain has left. items: those not flown to their end, the present one included; each
    has a way to its start and its path."""
    if phase == executive.TASK:
        return 2 * items - 1
    if phase == executive.DONE:
        return 0
    return 2 * items


def time_left(now: int, limit: int) -> int:
    """How long the flight may last still."""
    if now < limit:
        return limit - now
    return 0
