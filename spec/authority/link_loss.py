"""Flight without a link to UxAS: which mode is flown, and when it begins, changes and ends.

The mission chooses what is flown without the link. While that is not permitted, the vehicle loiters until it is. When
UxAS is heard again, the mode ends, and UxAS gets the vehicle back as after any takeover (`spec.authority.cycle`).
Milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.link_end import too_old

LINKED, FINISH, LOITER, RETURN, OVER, LAND, FINAL, LANDED = 0, 1, 2, 3, 4, 5, 6, 7
"""Modes: UxAS is heard; the known path is flown to its end; a circle is flown; a path to a named place is flown; the
chosen path has been flown to its end, and a circle is flown there; a path to a landing site is flown; the final
descent to the ground is flown; the vehicle is on the ground.
"""
NOTHING, BEGIN, FALL_BACK, END, REJOIN, COMMIT, TOUCH = 0, 1, 2, 3, 4, 5, 6
"""Events: nothing; the chosen mode begins; it is not permitted and a circle is flown; it has ended; UxAS is heard
again; the final descent begins; the ground is reached.
"""


class Loss(NamedTuple):
    """mode; since_ms: when it began [ms]."""

    mode: int
    since_ms: int


class Heartbeat(NamedTuple):
    """The result of a heartbeat. loss: the mode afterwards; act: the event."""

    loss: Loss
    act: int


def is_mode(mode: int) -> bool:
    """It is one of the eight modes."""
    return not (mode < LINKED or mode > LANDED)


def may_be_chosen(mode: int) -> bool:
    """A mission can choose this mode."""
    return not (mode < FINISH or mode > RETURN) or mode == LAND


def is_committed(mode: int) -> bool:
    """The vehicle is in its final descent, which only the ground ends, or on the ground."""
    return not (mode < FINAL or mode > LANDED)


def wanted(chosen: int, permitted: bool) -> int:
    """The mode to fly: the chosen one if its path is permitted, else a circle."""
    if permitted:
        return chosen
    return LOITER


def is_after_heartbeat(
    before: Loss,
    chosen: int,
    heard: int,
    now: int,
    bound: int,
    permitted: bool,
    ended: bool,
    after: Heartbeat,
) -> bool:
    """If UxAS is heard in time, no mode is flown. Otherwise a chosen mode that was flown to its end stays so; in the
    other cases the wanted mode is flown, with the time since when it has been wanted. The final descent begins at the
    end of the path to a landing site, while it is permitted down to the ground, and ends there, whatever is heard; a
    vehicle that has landed stays. permitted: the path of the chosen mode is permitted; ended: the vehicle is at the
    end of what is flown.
    """
    if before.mode == LANDED:
        return after == Heartbeat(before, NOTHING)
    if before.mode == FINAL:
        if ended:
            return after == Heartbeat(Loss(LANDED, now), TOUCH)
        return after == Heartbeat(before, NOTHING)
    if not too_old(heard, now, bound):
        if before.mode == LINKED:
            return after == Heartbeat(before, NOTHING)
        return after == Heartbeat(Loss(LINKED, now), REJOIN)
    if before.mode == OVER:
        return after == Heartbeat(before, NOTHING)
    if ended and before.mode == chosen and chosen != LOITER and chosen != LAND:
        return after == Heartbeat(Loss(OVER, now), END)
    if ended and before.mode == chosen and chosen == LAND and permitted:
        return after == Heartbeat(Loss(FINAL, now), COMMIT)
    mode = wanted(chosen, permitted)
    if before.mode == mode:
        return after == Heartbeat(before, NOTHING)
    if mode == chosen:
        return after == Heartbeat(Loss(mode, now), BEGIN)
    return after == Heartbeat(Loss(mode, now), FALL_BACK)


def must_fly(loss: Loss, foreseen: bool) -> bool:
    """ICAROUS has a reason to command the vehicle: a conflict is predicted, or the link is lost."""
    return foreseen or loss.mode != LINKED


def may_go_back(loss: Loss, free: bool) -> bool:
    """The vehicle may be offered to UxAS: the way back is free, and the link is not lost."""
    return not (loss.mode != LINKED or not free)
