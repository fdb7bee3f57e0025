"""What is meant by meeting at one time: the times at which all can, and the speeds at which one arrives then.

Source: the rendezvous task of UxAS; what its message leaves open is settled here. Metres, seconds; times of a run
in milliseconds.
"""

from __future__ import annotations

NO_END = -1
"""The latest time of who can wait for as long as it takes."""


def arrives_within(left: float, speed: float, until: float, tolerance: float) -> bool:
    """Who has this way left and flies it at this speed, > 0, arrives within the tolerance of the time that is left
    until then: left / speed is no farther from `until` than the tolerance, written without the quotient."""
    return speed * (until - tolerance) <= left and left <= speed * (until + tolerance)


def in_window(first: int, last: int, time: int) -> bool:
    """A time at which one can arrive who can from `first` on, until `last` or for ever."""
    return time >= first and (last == NO_END or time <= last)


def near_to(at: int, common: int, tolerance: int) -> bool:
    """Who arrived at `at` was within the tolerance of the common time."""
    return common - tolerance <= at and at <= common + tolerance


def beyond_line(north: float, east: float, ahead_north: float, ahead_east: float) -> bool:
    """Seen from a place, what lies so far north and east of it is not behind the line across a direction."""
    return north * ahead_north + east * ahead_east >= 0


def spread_of(left: float, lap: float, slowest: float, fastest: float) -> bool:
    """The way takes longer at the slowest speed than at the fastest by at least a lap: left / slowest - left / fastest
    >= lap, written without quotients. Premise: both speeds > 0."""
    return left * fastest - left * slowest >= lap * (slowest * fastest)


def later_by(left: float, until: float, lap: float, speed: float) -> bool:
    """Who begins a lap later flies the way at this speed, > 0, in what is left of the time then."""
    return left <= speed * (until - lap)
