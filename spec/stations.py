"""What is meant by following what moves: who can, and when a place was kept to for long enough.

Source: the tasks of IMPACT that keep to a moving entity (watch, multi vehicle watch, escort, blockade, comm
relay); what their messages leave open is settled here. Metres, seconds; times of a run in milliseconds.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, squared_distance

NOT_KEPT = -1
"""Since when a place is kept to, where it is not."""


def outruns_in(velocity: Point, speed: float, t: float) -> bool:
    """In the time t one flies farther at this speed than what moves so comes. FOR ALL t > 0.

    Then, and only then, it is caught up with from anywhere, and kept up with. Premise: speed >= 0.
    """
    north, east, flown = velocity.x * t, velocity.y * t, speed * t
    return north * north + east * east < flown * flown


def in_ring_at(p: Point, q: Point, least: float, most: float) -> bool:
    """q is no nearer to p than `least` and no farther than `most`. Premise: 0 <= least <= most."""
    apart = squared_distance(p, q)
    return least * least <= apart and apart <= most * most


def enough_at(there: int, needed: int) -> bool:
    """As many keep to their places as have to at one time."""
    return there >= needed


def since_after(since: int, there: int, needed: int, now: int) -> int:
    """Since when as many as have to have kept to their places without a break, at the instant `now` of which it
    is told how many do; NOT_KEPT if too few do."""
    if not enough_at(there, needed):
        return NOT_KEPT
    return now if since == NOT_KEPT else since


def long_enough(since: int, now: int, least: int) -> bool:
    """They have for the time that is asked for, more than 0; asked for 0, it is never over."""
    return since != NOT_KEPT and least > 0 and now - since >= least
