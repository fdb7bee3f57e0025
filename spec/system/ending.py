"""That things end: takeovers, silence, missions. Each measure here falls and cannot fall for ever. Milliseconds."""

from __future__ import annotations

from typing import NamedTuple

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


class Rank(NamedTuple):
    """What a vehicle has left, the first counting most: legs; takeovers and resumes on the leg that it is on; time [ms]."""

    legs: int
    changes: int
    time: int


class Flown(NamedTuple):
    """items, phase: as of `legs_left`; suspended: ICAROUS has the vehicle. Of the item that it is on: takeovers: so many;
    under_ms: ICAROUS has flown it for so long."""

    items: int
    phase: int
    suspended: bool
    takeovers: int
    under_ms: int


def changes_left(flown: Flown, most: int) -> int:
    """How often authority may still change on an item. A takeover after the last that is allowed gives it up."""
    if flown.phase == executive.DONE:
        return 0
    left = 2 * (most + 1 - flown.takeovers)
    if flown.suspended:
        return left + 1
    return left


def rank(flown: Flown, most: int, longest: int, now: int, limit: int) -> Rank:
    """What is left. most: takeovers that are allowed on an item; longest: how long ICAROUS may fly on it, in all; UxAS
    flies until the limit of the flight at most, as does whoever has nothing left to fly."""
    if flown.suspended and flown.phase != executive.DONE:
        time = longest - flown.under_ms
    else:
        time = time_left(now, limit)
    return Rank(legs_left(flown.items, flown.phase), changes_left(flown, most), time)


def is_rank(one: Rank) -> bool:
    """None is below 0, so that it cannot fall for ever."""
    return one.legs >= 0 and one.changes >= 0 and one.time >= 0


def falls(before: Rank, after: Rank) -> bool:
    """The first of the three that changes has become less."""
    if after.legs != before.legs:
        return after.legs < before.legs
    if after.changes != before.changes:
        return after.changes < before.changes
    return after.time < before.time


def within(flown: Flown, most: int, longest: int) -> bool:
    """What has been asked about at a heartbeat and was not given up: neither bound is passed."""
    fits = flown.takeovers <= most and flown.under_ms <= longest
    return flown.phase == executive.DONE or fits
