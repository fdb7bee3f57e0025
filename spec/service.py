"""When a task of a flight counts as served, given that not all of the flight was seen."""

from typing import NamedTuple

NOT_SERVED, SERVED, NOT_KNOWN = 0, 1, 2


class Watched(NamedTuple):
    """What was seen of a task. ended: it was flown to its end; over: the flight has ended; unseen: part of
    what counts was not seen; short: too little of a search was seen; near: it came within its standoff;
    missed: what its place asks for was not seen."""

    ended: bool
    over: bool
    unseen: bool
    short: bool
    near: bool
    missed: bool


def served_if(ends: bool, helped: bool, harmed: bool, seen: Watched) -> bool:
    """The task is served, if what was not seen, or is still to come, is like this: the task ends; what
    it lacks is done; it comes within its standoff. What is to come of a task can matter until it or
    the flight has ended; a search is seen by its own footprints alone.

    It is served for certain if this holds FOR ALL ends, helped and harmed; not served if it does for none.
    """
    to_come = not seen.ended and not seen.over
    ended = seen.ended or (to_come and ends)
    short = seen.short and not (to_come and helped)
    missed = seen.missed and not ((to_come or seen.unseen) and helped)
    near = seen.near or ((to_come or seen.unseen) and harmed)
    return ended and not (short or missed or near)
