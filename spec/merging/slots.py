"""Arrival slots at a merge fix: each in its vehicle's window, any two apart by the separation time. In milliseconds."""

from __future__ import annotations

from typing import NamedTuple


def in_window(earliest: int, latest: int, time: int) -> bool:
    """The time lies in the vehicle's window, in which it can be at the fix."""
    return not (time < earliest or time > latest)


def apart(one: int, other: int, separation: int) -> bool:
    """Two times differ by at least the separation, in either order."""
    if one < other:
        return other - one >= separation
    return one - other >= separation


def follows(free: int, earliest: int, latest: int, time: int) -> bool:
    """A slot may follow those before it: the fix is free, and the time is in the vehicle's window."""
    return time >= free and in_window(earliest, latest, time)


class Place(NamedTuple):
    """free: time from which the fix is free [ms]; fits: each vehicle so far has a slot; time: of the last slot [ms]."""

    free: int
    fits: bool
    time: int


def is_next_slot(
    t: int, before: Place, earliest: int, latest: int, separation: int, after: Place
) -> bool:
    """`after` is the place with the slot of one more vehicle. FOR ALL t.

    If each vehicle before has a slot, then either `after.time` is the earliest slot that may follow for this vehicle,
    and the fix is free again a separation later; or no time may follow, and `after.fits` is False. If a vehicle
    before has none, `after.fits` is False.
    """
    if not before.fits:
        return not after.fits
    does = follows(before.free, earliest, latest, t)
    if not after.fits:
        return not does
    right = follows(before.free, earliest, latest, after.time)
    soonest = not does or t >= after.time
    return right and soonest and after.free - after.time == separation
