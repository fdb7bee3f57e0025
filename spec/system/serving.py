"""That a chain is served, and when: no item of it is given up if takeovers and ICAROUS stays are bounded.
Milliseconds.

No component of the system stores a `Course`: it describes the real situation, heartbeat by heartbeat, beside the
state of the executive (`spec.system.ending.Flown`).
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.system.ending import Flown


class Bounds(NamedTuple):
    """items: of the chain; takeovers: maximum number on one item; stay_ms: maximum duration of one ICAROUS stay;
    own_ms: maximum time that UxAS flies the whole chain, including waits and paths back onto it.
    """

    items: int
    takeovers: int
    stay_ms: int
    own_ms: int


class Course(NamedTuple):
    """since_ms: how long the chain has been flown; own_ms: of that, by UxAS; stay_ms: duration of the present stay of
    ICAROUS; served, declared: number of items flown to their end, and declared failed; life: of the task of the
    present item; home: UxAS commanded the vehicle when the last item ended; bounded: so far everything was within
    `Bounds`, and nothing else has failed.
    """

    since_ms: int
    own_ms: int
    stay_ms: int
    served: int
    declared: int
    life: int
    home: bool
    bounded: bool


def stays_ms(bounds: Bounds) -> int:
    """Maximum time that ICAROUS flies on one item: one stay per takeover, plus one if the item begins under ICAROUS."""
    return (bounds.takeovers + 1) * bounds.stay_ms


def longest_ms(bounds: Bounds) -> int:
    """Maximum duration of the whole chain [ms]."""
    return bounds.own_ms + bounds.items * stays_ms(bounds)


def allowed(bounds: Bounds, most: int, longest: int) -> bool:
    """These bounds are within the limits at which an item is given up. most, longest: as in `is_given_up`."""
    sensible = bounds.items >= 0 and bounds.takeovers >= 0 and bounds.stay_ms >= 0
    return sensible and bounds.takeovers <= most and stays_ms(bounds) <= longest


def keeps(bounds: Bounds, takeovers: int, stay_ms: int, own_ms: int) -> bool:
    """The values so far are within the bounds."""
    return takeovers <= bounds.takeovers and stay_ms <= bounds.stay_ms and own_ms <= bounds.own_ms


def is_served(bounds: Bounds, flown: Flown, course: Course) -> bool:
    """While everything is within the bounds, no item has been declared failed, each item that is not left is served,
    none is left once the chain has been flown for its maximum duration, and UxAS commands the vehicle when the last
    item ends.
    """
    if not course.bounded:
        return True
    each = course.declared == 0 and course.served + flown.items == bounds.items
    ended = flown.items > 0 or course.home
    return each and ended and course.since_ms <= longest_ms(bounds)
