"""That a chain is served, and when: no item of it is given up where takeovers and stays are bounded. Milliseconds.

No part of the system keeps a `Course`: it is what is so out there, heartbeat by heartbeat, beside what the executive
keeps (`spec.system.ending.Flown`).
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.system.ending import Flown


class Bounds(NamedTuple):
    """items: of the chain; takeovers: so many come at most on one item; stay_ms: so long ICAROUS stays at most each
    time; own_ms: so long UxAS flies the whole chain at most, waits and ways back onto it included."""

    items: int
    takeovers: int
    stay_ms: int
    own_ms: int


class Course(NamedTuple):
    """since_ms: the chain was flown for so long, or is still; own_ms: so much of it by UxAS; stay_ms: so long the present stay of
    ICAROUS lasts; served, declared: so many items were flown to their end, and failed by name; life: of the task of the
    present item; home: UxAS had the vehicle as the last one ended; bounded: up to now all was as of `Bounds`, and
    nothing else has failed."""

    since_ms: int
    own_ms: int
    stay_ms: int
    served: int
    declared: int
    life: int
    home: bool
    bounded: bool


def stays_ms(bounds: Bounds) -> int:
    """So long ICAROUS flies on one item at most: once for each takeover, and where the item begins under it."""
    return (bounds.takeovers + 1) * bounds.stay_ms


def longest_ms(bounds: Bounds) -> int:
    """So long the whole chain lasts at most."""
    return bounds.own_ms + bounds.items * stays_ms(bounds)


def allowed(bounds: Bounds, most: int, longest: int) -> bool:
    """So many takeovers, and so long stays, no item is given up for. most, longest: as of `is_given_up`."""
    sensible = bounds.items >= 0 and bounds.takeovers >= 0 and bounds.stay_ms >= 0
    return sensible and bounds.takeovers <= most and stays_ms(bounds) <= longest


def keeps(bounds: Bounds, takeovers: int, stay_ms: int, own_ms: int) -> bool:
    """What has come so far is within the bounds."""
    return takeovers <= bounds.takeovers and stay_ms <= bounds.stay_ms and own_ms <= bounds.own_ms


def is_served(bounds: Bounds, flown: Flown, course: Course) -> bool:
    """While all is as of the bounds nothing has been declared, each item that is not left is served, none is left once
    the chain has been flown for as long as it can last, and UxAS has the vehicle as the last one ends."""
    if not course.bounded:
        return True
    each = course.declared == 0 and course.served + flown.items == bounds.items
    ended = flown.items > 0 or course.home
    return each and ended and course.since_ms <= longest_ms(bounds)
