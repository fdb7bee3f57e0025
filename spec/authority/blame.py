"""Who was in command at an instant, and what broke first by then, of what is told in a list.

The definitions run over the list in its order. Times are integers of one unit, between -2**61 and 2**61; a
place is the number of an entry in the list, and -1 is none.
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
