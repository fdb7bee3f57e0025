"""Who was in command at an instant, and what failed first by then, determined from a list of entries.

The definitions run over the list in order. Times are integers of one unit, between -2**61 and 2**61; a place is the
index of an entry in the list, -1 for none. Each definition is given twice: step by step, and for the list as a whole,
where an entry is the answer exactly if no other entry precedes it by the rule.
"""

from typing import NamedTuple

AGES = 4611686018427387904
"""2**62: later than any time of an entry; negated, earlier than any."""


class Latest(NamedTuple):
    """The latest entry that is not after the instant."""

    since: int
    place: int


def stood_step(latest: Latest, time: int, place: int, at: int) -> Latest:
    """Add an entry: the one in force at `at` has the greatest time that is not after `at`.

    Of several entries with that time, the last in the list counts.
    """
    told = time if time <= at else -AGES
    greatest = max(latest.since, told)
    return Latest(greatest, place if told == greatest and time <= at else latest.place)


class Asked(NamedTuple):
    """Whether one given entry is the one in force, for any list.

    time, place: of the entry; there: it is in the list; later: another entry, not after the instant, has a later
    time; after: an entry with the same time comes after it in the list; latest: the entry in force by the definition
    above.
    """

    time: int
    place: int
    there: bool
    later: bool
    after: bool
    latest: Latest


def asked_step(asked: Asked, time: int, place: int, at: int) -> Asked:
    """Add an entry of the list: the given entry itself, or a competing one."""
    latest = stood_step(asked.latest, time, place, at)
    if time == asked.time and place == asked.place:
        return Asked(asked.time, asked.place, True, asked.later, False, latest)
    later = asked.later or (time <= at and time > asked.time)
    after = asked.after or time == asked.time
    return Asked(asked.time, asked.place, asked.there, later, after, latest)


def stands(asked: Asked, at: int) -> bool:
    """It is in the list, not after the instant, and NO other entry is later, or equally late and after it in the
    list.
    """
    return asked.there and asked.time <= at and not asked.later and not asked.after


class Earliest(NamedTuple):
    """The earliest entry that is not after the instant."""

    since: int
    place: int


def broke_step(earliest: Earliest, since: int, place: int, at: int) -> Earliest:
    """Add an entry: the first failure by `at` has the least of the times that are not after `at`.

    Of several entries with that time, the first in the list counts.
    """
    told = since if since <= at else AGES
    least = min(earliest.since, told)
    return Earliest(least, place if least < earliest.since else earliest.place)


class Blamed(NamedTuple):
    """Whether one given entry is the first failure, for any list.

    since, place: of the entry; there: it is in the list; beaten: another entry is earlier, or equally early and
    before it in the list; earliest: the first failure by the definition above.
    """

    since: int
    place: int
    there: bool
    beaten: bool
    earliest: Earliest


def blamed_step(blamed: Blamed, since: int, place: int, at: int) -> Blamed:
    """Add an entry of the list: the given entry itself, or a competing one."""
    earliest = broke_step(blamed.earliest, since, place, at)
    if since == blamed.since and place == blamed.place:
        return Blamed(blamed.since, blamed.place, True, blamed.beaten, earliest)
    beats = since < blamed.since if blamed.there else since <= blamed.since
    return Blamed(blamed.since, blamed.place, blamed.there, blamed.beaten or beats, earliest)


def came_first(blamed: Blamed, at: int) -> bool:
    """It is in the list, not after the instant, and NO other entry is earlier, or equally early and before it in the
    list.
    """
    return blamed.there and blamed.since <= at and not blamed.beaten
