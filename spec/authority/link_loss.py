"""What a vehicle does by itself while UxAS is not heard: one mode at a time, begun, left and ended by rule.

The mission chooses what is flown without the link. Where nothing permits that, the vehicle loiters until
something does. It is heard again: what was chosen is over, and UxAS gets the vehicle back as from any takeover
(`spec.authority.cycle`). Milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.link_end import too_old

LINKED, FINISH, LOITER, RETURN, OVER, LAND, FINAL, LANDED = 0, 1, 2, 3, 4, 5, 6, 7
"""UxAS is heard; the known way is flown to its end; a circle is flown; a way to a named place is flown; what was
chosen has been flown to its end, and a circle is flown there; a way to a landing site is flown; the last descent is,
to the ground; the vehicle is on the ground."""
NOTHING, BEGIN, FALL_BACK, END, REJOIN, COMMIT, TOUCH = 0, 1, 2, 3, 4, 5, 6
"""What is new: nothing; what is chosen begins; nothing permits it, a circle is flown; it has ended; UxAS is heard; the
last descent begins; the ground is reached."""


class Loss(NamedTuple):
    """mode; since_ms: since when [ms]."""

    mode: int
    since_ms: int


class Heartbeat(NamedTuple):
    """What a heartbeat leads to: loss: the mode afterwards; act: what is new."""

    loss: Loss
    act: int


def is_mode(mode: int) -> bool:
    """It is one of the eight."""
    return not (mode < LINKED or mode > LANDED)


def may_be_chosen(mode: int) -> bool:
    """A mission can ask for it."""
    return not (mode < FINISH or mode > RETURN) or mode == LAND


def is_committed(mode: int) -> bool:
    """The vehicle is so low that nothing but the ground ends it, or is there."""
    return not (mode < FINAL or mode > LANDED)


def wanted(chosen: int, permitted: bool) -> int:
    """What is to be flown: what is chosen if its way is permitted, else a circle."""
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
    """Heard in time there is no mode. Else what was chosen and flown to its end stays so, and of the others the
    one that is wanted is flown, since it was wanted first. The last descent begins at the end of the way to a landing
    site, while it is permitted to the ground, and ends there, whatever is heard; who has landed stays. permitted: the
    way of what is chosen is, and what is flown is ended once the vehicle is at its end."""
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
    """ICAROUS has a reason to have the vehicle: a conflict is foreseen, or the link is lost."""
    return foreseen or loss.mode != LINKED


def may_go_back(loss: Loss, free: bool) -> bool:
    """UxAS may be offered the vehicle: the way back is free, and the link is not lost."""
    return not (loss.mode != LINKED or not free)
