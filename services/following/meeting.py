"""The search for when a vehicle meets what moves: doubling until it is in time, then a secant kept in its bracket."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

DOUBLINGS = 16
"""What is moving is not met if this many doublings of the flight time do not suffice."""
SECANTS, HALVINGS = 12, 60
"""After this many steps by the secant the bracket is halved, so often at most."""
NARROW = 1e-9
"""The bracket is as narrow as this at the end, in the unit of its argument."""


class Look(NamedTuple):
    """What is found at an argument: short of the goal, as a kernel decides; by how much, which only guides."""

    short: bool
    by: float


def first_met(look: Callable[[float], Look], guess: float) -> float | None:
    """An argument from 0 on at which a vehicle is no longer short of its goal, at most `NARROW` after one at which
    it is, unless it is short at none; None if it is still short after `DOUBLINGS` doublings of a guess, >= 0.

    Where what is looked at grows and falls, so that there are several such arguments, it is any one of them.
    """
    short_at, short = 0.0, look(0.0)
    if not short.short:
        return 0.0
    at = guess
    for _ in range(DOUBLINGS):
        found = look(at)
        if not found.short:
            return narrowed(look, (short_at, short), (at, found))
        short_at, short, at = at, found, 2 * at + 1.0
    return None


def narrowed(
    look: Callable[[float], Look], short: tuple[float, Look], there: tuple[float, Look]
) -> float:
    """The same between an argument that is short and a greater one that is there, with what was found at each."""
    low, high = short[0], there[0]
    (before, before_by), (last, last_by) = (there[0], there[1].by), (short[0], short[1].by)
    for turn in range(SECANTS + HALVINGS):
        if high - low <= NARROW:
            break
        at = (low + high) / 2
        if turn < SECANTS and last_by != before_by:
            secant = last - last_by * (last - before) / (last_by - before_by)
            # at an end: just beside it, which closes the bracket if the other end is as near
            if low <= secant <= high:
                at = min(max(secant, low + NARROW / 2), high - NARROW / 2)
        found = look(at)
        low, high = (at, high) if found.short else (low, at)
        before, before_by, last, last_by = last, last_by, at, found.by
    return high
