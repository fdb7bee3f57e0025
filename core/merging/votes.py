"""Votes for a leader among the vehicles that merge at a fix, as transition kernels. Definitions: `spec.merging.votes`.

Terms and votes are those of Raft (Ongaro, Ousterhout 2014), without its log: what is agreed upon are slots, which members
grant (`core.merging.grants`).
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Seat(NamedTuple):
    """latest: the latest term that a member knows; voted: whom it has voted for in it, 0 nobody yet."""

    latest: int
    voted: int


class Vote(NamedTuple):
    """seat: afterwards; yes: the member is for the candidate in that term."""

    seat: Seat
    yes: bool


@kernel(implements="merging.votes.is_after_ask")
def seat_asked(seat: Seat, term: int, candidate: int) -> Vote:
    """A candidate asks for a vote in a term, or its leader speaks in it. candidate: its id, > 0."""
    if term < seat.latest:
        return Vote(seat, False)
    if term == seat.latest and seat.voted != 0 and seat.voted != candidate:
        return Vote(seat, False)
    return Vote(Seat(term, candidate), True)


class Standing(NamedTuple):
    """seat: afterwards; stands: the member does."""

    seat: Seat
    stands: bool


@kernel(implements="merging.votes.stands_in")
def seat_stands(seat: Seat, member: int) -> Standing:
    """The member stands in the next term; not in one that could not be counted. member: its id, > 0."""
    if seat.latest >= 1152921504606846976:
        return Standing(seat, False)
    return Standing(Seat(seat.latest + 1, member), True)


@kernel(implements="merging.votes.counted")
def tally_step(count: int, has: bool) -> int:
    """One member more is looked at. has: it is for what is counted; no more than 2^30 are counted."""
    if has and count < 1073741824:
        return count + 1
    return count


tally = fold(name="tally", implements="merging.votes.number_with", step=tally_step, start=0)


@kernel(implements="merging.votes.is_majority")
def is_majority(count: int, members: int) -> bool:
    """True iff so many are more than half of the members."""
    return count + count > members
