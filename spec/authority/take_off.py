"""How a vehicle that starts on the ground leaves it: one mode at a time, begun, left and broken off by rule.

It stands until a way up is permitted and UxAS is heard, rolls while both stay so, and is off the ground only after such a
roll. It climbs along that way while both stay so; else the climb is left to avoidance, or to what is flown without the
link. At the end of the way UxAS may get the vehicle, as from any takeover (`spec.authority.cycle`). Milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.link_end import too_old

STANDING, ROLLING, CLIMBING, UP = 0, 1, 2, 3
"""It stands on the ground, or brakes to a stand; it rolls faster and faster; it is off the ground, on its way up; that is
over, or it started in the air."""
NOTHING, BEGIN, BREAK_OFF, LIFT_OFF, END, LEAVE = 0, 1, 2, 3, 4, 5
"""What is new: nothing; the roll begins; it is broken off; the vehicle is off the ground; it is at the end of its way up;
that way is not permitted any more, or UxAS is not heard."""


class Departure(NamedTuple):
    """mode; since_ms: since when [ms]."""

    mode: int
    since_ms: int


class Heartbeat(NamedTuple):
    """What a heartbeat leads to: departure: the mode afterwards; act: what is new."""

    departure: Departure
    act: int


def is_mode(mode: int) -> bool:
    """It is one of the four."""
    return not (mode < STANDING or mode > UP)


def is_on_ground(mode: int) -> bool:
    """The vehicle has not left the ground."""
    return not (mode < STANDING or mode > ROLLING)


def may(heard: int, now: int, bound: int, permitted: bool) -> bool:
    """The way up is permitted, and UxAS has not been silent for more than the bound."""
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
    """Who is up stays so. In the air the way up ends where it ends, or is left where it may not be flown. On the ground
    it is noticed first that the vehicle has left it; else it rolls if it may, and does not if it may not. permitted: its
    way up is; airborne: it is off the ground; ended: it is at the end of the way."""
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
    """ICAROUS has a reason to have the vehicle: a conflict is foreseen, or it is not up yet."""
    return foreseen or departure.mode != UP


def may_go_back(departure: Departure, free: bool) -> bool:
    """UxAS may be offered the vehicle: the way back is free, and it is up."""
    return not (departure.mode != UP or not free)
