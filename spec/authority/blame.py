"""Who was in command at an instant, and what broke first by then, of what is told in a list.

The definitions run over the list in its order. Times are integers of one unit, between -2**61 and 2**61; a
place is the number of an entry in the list, and -1 is none. Each of the two is also said of the list as a whole: an entry
is the one exactly if none of the others beats it.
"""

from typing import NamedTuple

AGES = 4611686018427387904
"""2**62: later than any time of an entry, and with a minus earlier."""


class Latest(NamedTuple):
    """The latest entry that is not after the instant."""

    since: int
    place: int


def stood_step(latest: Latest, time: int, place: int, at: int) -> Latest:
    """An entry more: what stands at `at` was told at the greatest of the times that are not after it.

    Of several at that time the last one told stands.
    """
    told = time if time <= at else -AGES
    greatest = max(latest.since, told)
    return Latest(greatest, place if told == greatest and time <= at else latest.place)


class Asked(NamedTuple):
    """Is one entry the one that stands? Asked of any entry, whatever the list.

    time, place: of the entry; there: it is in the list; later: another one that is told by the instant is later;
    after: one that is as late is told after it; latest: what stands by the definition above.
    """

    time: int
    place: int
    there: bool
    later: bool
    after: bool
    latest: Latest


def asked_step(asked: Asked, time: int, place: int, at: int) -> Asked:
    """An entry more of the list: the entry itself, or a rival of it."""
    latest = stood_step(asked.latest, time, place, at)
    if time == asked.time and place == asked.place:
        return Asked(asked.time, asked.place, True, asked.later, False, latest)
    later = asked.later or (time <= at and time > asked.time)
    after = asked.after or time == asked.time
    return Asked(asked.time, asked.place, asked.there, later, after, latest)


def stands(asked: Asked, at: int) -> bool:
    """It is in the list, told by the instant, and of all that are NONE is later and NONE as late and after it."""
    return asked.there and asked.time <= at and not asked.later and not asked.after


class Earliest(NamedTuple):
    """The earliest entry that is not after the instant."""

    since: int
    place: int


def broke_step(earliest: Earliest, since: int, place: int, at: int) -> Earliest:
    """An entry more: what broke first by `at` did so at the least of the times that are not after it.

    Of several at that time it is the one that stands first in the list.
    """
    told = since if since <= at else AGES
    least = min(earliest.since, told)
    return Earliest(least, place if least < earliest.since else earliest.place)


class Blamed(NamedTuple):
    """Is one entry the one that came first? Asked of any entry, whatever the list.

    since, place: of the entry; there: it is in the list; beaten: another one is sooner, or as soon and stands before
    it; earliest: what came first by the definition above.
    """

    since: int
    place: int
    there: bool
    beaten: bool
    earliest: Earliest


def blamed_step(blamed: Blamed, since: int, place: int, at: int) -> Blamed:
    """An entry more of the list: the entry itself, or a rival of it."""
    earliest = broke_step(blamed.earliest, since, place, at)
    if since == blamed.since and place == blamed.place:
        return Blamed(blamed.since, blamed.place, True, blamed.beaten, earliest)
    beats = since < blamed.since if blamed.there else since <= blamed.since
    return Blamed(blamed.since, blamed.place, blamed.there, blamed.beaten or beats, earliest)


def came_first(blamed: Blamed, at: int) -> bool:
    """It is in the list, is by the instant, and of all NONE is sooner and NONE as soon and before it."""
    return blamed.there and blamed.since <= at and not blamed.beaten
