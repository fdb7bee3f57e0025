"""Votes for a leader among the vehicles that merge at a fix: one per member and term; a majority elects a leader."""

from __future__ import annotations

from typing import NamedTuple

NOBODY = 0


class Seat(NamedTuple):
    """latest: the latest term that a member knows; voted: the candidate it voted for in that term, 0 for none yet."""

    latest: int
    voted: int


class Vote(NamedTuple):
    """seat: the seat afterwards; yes: whether the candidate has the member's vote in that term."""

    seat: Seat
    yes: bool


def is_majority(count: int, members: int) -> bool:
    """The counted members are more than those not counted."""
    return members - count < count


def counted(before: int, has: bool, after: int) -> bool:
    """The count goes up by one exactly if the member is counted."""
    return after - before == (1 if has else 0)


MOST = 1 << 30
"""Largest count."""


def number_with(before: int, has: bool) -> int:
    """The count with one more member, at most MOST. has: whether that member is counted."""
    return min(before + (1 if has else 0), MOST)


def is_after_ask(before: Seat, term: int, candidate: int, after: Vote) -> bool:
    """A member votes for the first candidate that asks in a term and for no other; earlier terms are refused."""
    if term < before.latest:
        return after == Vote(before, False)
    free = term > before.latest or before.voted == NOBODY
    if free or before.voted == candidate:
        return after == Vote(Seat(term, candidate), True)
    return after == Vote(before, False)


def stands_in(before: Seat, member: int, after: Seat) -> bool:
    """A member stands for election in a later term than any it knows, and votes for itself."""
    return after.latest > before.latest and after.voted == member
