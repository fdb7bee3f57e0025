"""What it means that a loss could not be avoided.

A manoeuvre is a way that the ownship could fly from now on: straight pieces, one after another. It
is refused if at some instant of some piece the volume of another aircraft is violated, and not by a
hair; it is free if all of it could be looked at and at no instant a volume is violated; else it is
open. There is a way out if some manoeuvre is free, and none if there are manoeuvres and every one of
them is refused; anything else is undecided, and so is what two judges answer differently. A loss is
excused only where there was no way out at any instant at which it could still have been avoided.
"""

from typing import NamedTuple


class Flown(NamedTuple):
    """A manoeuvre so far: whether it was refused, and whether anything in it is open."""

    refused: bool
    open: bool


def lost_at(violated: bool, t: float, piece: float) -> bool:
    """Violated t seconds after the begin of a piece, while it is flown."""
    return t >= 0 and t <= piece and violated


def flown_step(flown: Flown, known: bool, lost: bool, surely: bool) -> Flown:
    """A piece more: whether the other aircraft is known then, the volume lost, and not by a hair."""
    return Flown(flown.refused or (known and lost and surely), flown.open or not known or lost)


def judged(flown: Flown) -> int:
    """-1 refused, 0 open, 1 free."""
    if flown.refused:
        return -1
    if flown.open:
        return 0
    return 1


class Tried(NamedTuple):
    """Manoeuvres so far: whether one is free, whether one is open, whether there is any."""

    free: bool
    open: bool
    some: bool


def tried_step(tried: Tried, manoeuvre: int) -> Tried:
    """A manoeuvre more; what is neither free nor refused is open."""
    if manoeuvre == 1:
        return Tried(True, tried.open, True)
    if manoeuvre == -1:
        return Tried(tried.free, tried.open, True)
    return Tried(tried.free, True, True)


def answer(tried: Tried) -> int:
    """1 there is a way out, -1 there is none, 0 undecided."""
    if tried.free:
        return 1
    if tried.some and not tried.open:
        return -1
    return 0


def agreed(one: int, other: int, said: int) -> bool:
    """What both answer is said; a yes and a no, or anything else, is undecided."""
    if one == 1 and other == 1:
        return said == 1
    if one == -1 and other == -1:
        return said == -1
    return said == 0


def excuses(answer_: int) -> bool:
    """Only that there was no way out excuses."""
    return answer_ == -1
