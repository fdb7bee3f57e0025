"""Arrival slots at a merge fix: each in its vehicle's window, any two apart by the separation time. Milliseconds."""

from __future__ import annotations

from typing import NamedTuple


def in_window(earliest: int, latest: int, time: int) -> bool:
    """A time at which a vehicle can be there."""
    return not (time < earliest or time > latest)


def apart(one: int, other: int, separation: int) -> bool:
    """Two times are no nearer than the separation, whichever is first."""
    if one < other:
        return other - one >= separation
    return one - other >= separation


def follows(free: int, earliest: int, latest: int, time: int) -> bool:
    """A slot that comes after all before it: when they leave the fix free, and in the vehicle's window."""
    return time >= free and in_window(earliest, latest, time)


class Place(NamedTuple):
    """free: from when on the fix is free [ms]; fits: each so far has a slot; time: of the last one [ms]."""

    free: int
    fits: bool
    time: int


def is_next_slot(
    t: int, before: Place, earliest: int, latest: int, separation: int, after: Place
) -> bool:
    """If each before has a slot: no time before `after.time` would do for this vehicle, that one does, and the fix is free
    again a separation later; or none would do, and that is said. If not, it stays so. FOR ALL t."""
    if not before.fits:
        return not after.fits
    does = follows(before.free, earliest, latest, t)
    if not after.fits:
        return not does
    right = follows(before.free, earliest, latest, after.time)
    soonest = not does or t >= after.time
    return right and soonest and after.free - after.time == separation
