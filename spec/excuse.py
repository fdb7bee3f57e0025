"""When a loss counts as unavoidable.

A manoeuvre is a path that the ownship could fly from now on, in straight segments. It is refused if at some instant
of some segment the volume of another aircraft is violated by a margin; it is free if all of it could be examined and no
volume is violated at any instant; otherwise it is open. There is a way out if some manoeuvre is free, and none if
there are manoeuvres and every one of them is refused; anything else is undecided, as is a case on which two judges
differ. A loss is excused only if there was no way out at any instant at which it could still have been avoided.
"""

from typing import NamedTuple


class Flown(NamedTuple):
    """A manoeuvre so far: whether it was refused, and whether anything in it is open."""

    refused: bool
    open: bool


def lost_at(violated: bool, t: float, piece: float) -> bool:
    """Violated t seconds after the beginning of a segment, while it is flown."""
    return t >= 0 and t <= piece and violated


def flown_step(flown: Flown, known: bool, lost: bool, surely: bool) -> Flown:
    """Add a segment. known: the other aircraft's state is known; lost: the volume is lost; surely: it is lost by a
    margin.
    """
    return Flown(flown.refused or (known and lost and surely), flown.open or not known or lost)


def judged(flown: Flown) -> int:
    """Verdict on a manoeuvre: -1 refused, 0 open, 1 free."""
    if flown.refused:
        return -1
    if flown.open:
        return 0
    return 1


class Tried(NamedTuple):
    """Manoeuvres so far: whether one is free, whether one is open, whether there are any."""

    free: bool
    open: bool
    some: bool


def tried_step(tried: Tried, manoeuvre: int) -> Tried:
    """Add a manoeuvre; a verdict that is neither free nor refused counts as open."""
    if manoeuvre == 1:
        return Tried(True, tried.open, True)
    if manoeuvre == -1:
        return Tried(tried.free, tried.open, True)
    return Tried(tried.free, True, True)


def answer(tried: Tried) -> int:
    """1: there is a way out; -1: there is none; 0: undecided."""
    if tried.free:
        return 1
    if tried.some and not tried.open:
        return -1
    return 0


def agreed(one: int, other: int, said: int) -> bool:
    """The common answer of both judges if it is 1 or -1; otherwise undecided (0)."""
    if one == 1 and other == 1:
        return said == 1
    if one == -1 and other == -1:
        return said == -1
    return said == 0


def excuses(answer_: int) -> bool:
    """A loss is excused only by the answer that there was no way out."""
    return answer_ == -1
