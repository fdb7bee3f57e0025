"""Votes for a leader among the vehicles that merge at a fix: one a term, and a majority makes a leader."""

from __future__ import annotations

from typing import NamedTuple

NOBODY = 0


class Seat(NamedTuple):
    """latest: the latest term that a member knows; voted: whom it has voted for in it, 0 nobody yet."""

    latest: int
    voted: int


class Vote(NamedTuple):
    """seat: afterwards; yes: the member is for the candidate in that term."""

    seat: Seat
    yes: bool


def is_majority(count: int, members: int) -> bool:
    """Those who are not among them are fewer than they are."""
    return members - count < count


def counted(before: int, has: bool, after: int) -> bool:
    """Who is among them is one more."""
    return after - before == (1 if has else 0)


MOST = 1 << 30
"""No more members are counted."""


def number_with(before: int, has: bool) -> int:
    """How many are among them with one more member, up to MOST."""
    return min(before + (1 if has else 0), MOST)


def is_after_ask(before: Seat, term: int, candidate: int, after: Vote) -> bool:
    """A member is for whoever asks first in a term, and for nobody else in it; a term that is over is answered by no."""
    if term < before.latest:
        return after == Vote(before, False)
    free = term > before.latest or before.voted == NOBODY
    if free or before.voted == candidate:
        return after == Vote(Seat(term, candidate), True)
    return after == Vote(before, False)


def stands_in(before: Seat, member: int, after: Seat) -> bool:
    """Who stands does so in a term of which it knows nothing yet, and votes for itself."""
    return after.latest > before.latest and after.voted == member
