"""When a task of a flight counts as served, given that only part of the flight was observed."""

from typing import NamedTuple

NOT_SERVED, SERVED, NOT_KNOWN = 0, 1, 2


class Watched(NamedTuple):
    """Observations of a task. ended: it was flown to its end; over: the flight has ended; unseen: part of what counts
    was not observed; short: too little of a search was seen; near: the vehicle came within its standoff distance;
    missed: what its location requires was not seen.
    """

    ended: bool
    over: bool
    unseen: bool
    short: bool
    near: bool
    missed: bool


def served_if(ends: bool, helped: bool, harmed: bool, seen: Watched) -> bool:
    """The task is served under assumptions on what was not observed or is still to come. ends: the task ends; helped:
    what it lacks is done; harmed: the vehicle comes within the standoff distance. What is still to come can matter
    until the task or the flight has ended; a search is served only by its own footprints.

    It is certainly served if this holds FOR ALL ends, helped and harmed; certainly not served if for none.
    """
    to_come = not seen.ended and not seen.over
    ended = seen.ended or (to_come and ends)
    short = seen.short and not (to_come and helped)
    missed = seen.missed and not ((to_come or seen.unseen) and helped)
    near = seen.near or ((to_come or seen.unseen) and harmed)
    return ended and not (short or missed or near)
