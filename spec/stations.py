"""Following a moving entity: who can, and when a station was kept for long enough.

Source: the tasks of IMPACT that keep station on a moving entity (watch, multi vehicle watch, escort, blockade, comm
relay); what their messages leave open is defined here. Metres, seconds; times of a run in milliseconds.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, squared_distance

NOT_KEPT = -1
"""Value of "kept since" for a station that is not kept."""


def outruns_in(velocity: Point, speed: float, t: float) -> bool:
    """In the time t a vehicle at this speed flies farther than the entity moves. FOR ALL t > 0.

    Then, and only then, it can be caught up from any position, and kept up with. Premise: speed >= 0.
    """
    north, east, flown = velocity.x * t, velocity.y * t, speed * t
    return north * north + east * east < flown * flown


def in_ring_at(p: Point, q: Point, least: float, most: float) -> bool:
    """q is at least `least` and at most `most` from p. Premise: 0 <= least <= most."""
    apart = squared_distance(p, q)
    return least * least <= apart and apart <= most * most


def enough_at(there: int, needed: int) -> bool:
    """The required number of vehicles are on station at the same time."""
    return there >= needed


def since_after(since: int, there: int, needed: int, now: int) -> int:
    """The time since when enough vehicles have continuously kept station, updated at the instant `now` with the
    number on station; NOT_KEPT if there are too few.
    """
    if not enough_at(there, needed):
        return NOT_KEPT
    return now if since == NOT_KEPT else since


def long_enough(since: int, now: int, least: int) -> bool:
    """Station was kept for the required time, more than 0; for 0 the task never ends."""
    return since != NOT_KEPT and least > 0 and now - since >= least
