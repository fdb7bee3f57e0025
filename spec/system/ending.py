"""Termination: takeovers, silence, missions. Each measure here decreases and is bounded below. Milliseconds."""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec import executive
from cratous.spec.authority import gate as authority

MOST_PATIENCE = 16
"""Upper bound, as a multiple of the least time, of how long the way back must be free."""


def over(now: int, begun: int, most: int) -> bool:
    """At least `most` has passed since `begun`."""
    return not now < begun + most


def handed_back(gate: authority.State) -> bool:
    """UxAS alone commands."""
    return authority.may_command(gate, 0) and not authority.may_command(gate, 1)


def task_steps_left(life: int) -> int:
    """How many more state changes a task can go through: it may begin, and it may end or fail."""
    if executive.settled(life):
        return 0
    if life == executive.LEFT:
        return 2
    return 1


def legs_left(items: int, phase: int) -> int:
    """How many legs a chain has left. items: those not flown to their end, including the present one; each has a
    transit to its start, and its path.
    """
    if phase == executive.TASK:
        return 2 * items - 1
    if phase == executive.DONE:
        return 0
    return 2 * items


def time_left(now: int, limit: int) -> int:
    """The maximum remaining duration of the flight [ms]."""
    if now < limit:
        return limit - now
    return 0


class Rank(NamedTuple):
    """What a vehicle has left, in lexicographic order: legs; takeovers and resumes on the present leg; time [ms]."""

    legs: int
    changes: int
    time: int


class Flown(NamedTuple):
    """items, phase: as in `legs_left`; suspended: ICAROUS commands the vehicle. On the present item: takeovers: their
    number; under_ms: how long ICAROUS has flown it [ms].
    """

    items: int
    phase: int
    suspended: bool
    takeovers: int
    under_ms: int


def changes_left(flown: Flown, most: int) -> int:
    """How often authority may still change on an item. One more takeover than allowed gives the item up."""
    if flown.phase == executive.DONE:
        return 0
    left = 2 * (most + 1 - flown.takeovers)
    if flown.suspended:
        return left + 1
    return left


def rank(flown: Flown, most: int, longest: int, now: int, limit: int) -> Rank:
    """What is left. most: allowed takeovers on an item; longest: total time that ICAROUS may fly on it; UxAS flies at
    most until the time limit of the flight, as does a vehicle with nothing left to fly.
    """
    if flown.suspended and flown.phase != executive.DONE:
        time = longest - flown.under_ms
    else:
        time = time_left(now, limit)
    return Rank(legs_left(flown.items, flown.phase), changes_left(flown, most), time)


def is_rank(one: Rank) -> bool:
    """No component is negative, so that the rank cannot decrease for ever."""
    return one.legs >= 0 and one.changes >= 0 and one.time >= 0


def falls(before: Rank, after: Rank) -> bool:
    """The first of the three components that changes has decreased."""
    if after.legs != before.legs:
        return after.legs < before.legs
    if after.changes != before.changes:
        return after.changes < before.changes
    return after.time < before.time


def within(flown: Flown, most: int, longest: int) -> bool:
    """An item checked at a heartbeat and not given up: neither bound is exceeded."""
    fits = flown.takeovers <= most and flown.under_ms <= longest
    return flown.phase == executive.DONE or fits
