"""Rendezvous at a common time: the feasible times, and the speeds at which a vehicle arrives then.

Source: the rendezvous task of UxAS; what its message leaves open is defined here. Metres, seconds; times of a run in
milliseconds.
"""

from __future__ import annotations

NO_END = -1
"""The latest arrival of a vehicle that can wait without limit."""


def arrives_within(left: float, speed: float, until: float, tolerance: float) -> bool:
    """A vehicle with this distance left at this speed, > 0, arrives within the tolerance of the remaining time: left
    / speed differs from `until` by at most the tolerance, written without the quotient.
    """
    return speed * (until - tolerance) <= left and left <= speed * (until + tolerance)


def in_window(first: int, last: int, time: int) -> bool:
    """The time is a feasible arrival: from `first` on, up to `last` or without limit."""
    return time >= first and (last == NO_END or time <= last)


def near_to(at: int, common: int, tolerance: int) -> bool:
    """The arrival at `at` was within the tolerance of the common time."""
    return common - tolerance <= at and at <= common + tolerance


def beyond_line(north: float, east: float, ahead_north: float, ahead_east: float) -> bool:
    """A point at offset (north, east) is not behind the line through 0 perpendicular to the direction (ahead_north,
    ahead_east).
    """
    return north * ahead_north + east * ahead_east >= 0


def spread_of(left: float, lap: float, slowest: float, fastest: float) -> bool:
    """The flight times at the slowest and the fastest speed differ by at least a lap: left / slowest - left / fastest
    >= lap, written without quotients. Premise: both speeds > 0.
    """
    return left * fastest - left * slowest >= lap * (slowest * fastest)


def later_by(left: float, until: float, lap: float, speed: float) -> bool:
    """A vehicle that begins one lap later flies the distance at this speed, > 0, in the time then remaining."""
    return left <= speed * (until - lap)
