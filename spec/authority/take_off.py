"""Take-off of a vehicle that starts on the ground: which mode it is in, and when each begins and ends.

It stands until its climb path is permitted and UxAS is heard, rolls while both remain so, and leaves the ground only
after such a roll. It climbs along that path while both remain so; otherwise the climb is left to avoidance, or to
what is flown without the link. At the end of the path UxAS may get the vehicle, as after any takeover
(`spec.authority.cycle`). Milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.link_end import too_old

STANDING, ROLLING, CLIMBING, UP = 0, 1, 2, 3
"""Modes: standing on the ground, or braking to a stop; accelerating on the ground; airborne on the climb path;
take-off over, or started in the air.
"""
NOTHING, BEGIN, BREAK_OFF, LIFT_OFF, END, LEAVE = 0, 1, 2, 3, 4, 5
"""Events: nothing; the roll begins; it is aborted; the vehicle is airborne; it is at the end of the climb path; the
climb path is no longer permitted, or UxAS is not heard.
"""


class Departure(NamedTuple):
    """mode; since_ms: when it began [ms]."""

    mode: int
    since_ms: int


class Heartbeat(NamedTuple):
    """The result of a heartbeat. departure: the mode afterwards; act: the event."""

    departure: Departure
    act: int


def is_mode(mode: int) -> bool:
    """It is one of the four modes."""
    return not (mode < STANDING or mode > UP)


def is_on_ground(mode: int) -> bool:
    """The vehicle has not left the ground."""
    return not (mode < STANDING or mode > ROLLING)


def may(heard: int, now: int, bound: int, permitted: bool) -> bool:
    """The climb path is permitted, and UxAS has not been silent for longer than the bound."""
    return not (too_old(heard, now, bound) or not permitted)


def is_after_heartbeat(
    before: Departure,
    heard: int,
    now: int,
    bound: int,
    permitted: bool,
    airborne: bool,
    ended: bool,
    after: Heartbeat,
) -> bool:
    """After take-off is over it stays over. In the air the climb ends at the end of its path, or is left where it may
    no longer be flown. On the ground, leaving the ground is noticed first; otherwise the vehicle rolls if it may, and
    does not if it may not. permitted: its climb path is permitted; airborne: it is off the ground; ended: it is at
    the end of the path.
    """
    if before.mode == UP:
        return after == Heartbeat(before, NOTHING)
    if before.mode == CLIMBING:
        if ended:
            return after == Heartbeat(Departure(UP, now), END)
        if may(heard, now, bound, permitted):
            return after == Heartbeat(before, NOTHING)
        return after == Heartbeat(Departure(UP, now), LEAVE)
    if airborne:
        return after == Heartbeat(Departure(CLIMBING, now), LIFT_OFF)
    mode = ROLLING if may(heard, now, bound, permitted) else STANDING
    if before.mode == mode:
        return after == Heartbeat(before, NOTHING)
    if mode == ROLLING:
        return after == Heartbeat(Departure(mode, now), BEGIN)
    return after == Heartbeat(Departure(mode, now), BREAK_OFF)


def must_fly(departure: Departure, foreseen: bool) -> bool:
    """ICAROUS has a reason to command the vehicle: a conflict is predicted, or take-off is not over."""
    return foreseen or departure.mode != UP


def may_go_back(departure: Departure, free: bool) -> bool:
    """The vehicle may be offered to UxAS: the way back is free, and take-off is over."""
    return not (departure.mode != UP or not free)
