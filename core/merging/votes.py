"""Votes for a leader among the vehicles that merge at a fix, as transition kernels. Definitions: `spec.merging.votes`.

Terms and votes are those of Raft (Ongaro, Ousterhout 2014), without its log: the members agree on slots, by granting
them (`core.merging.grants`).
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Seat(NamedTuple):
    """latest: the latest term that a member knows; voted: the candidate it voted for in that term, 0 for none yet."""

    latest: int
    voted: int


class Vote(NamedTuple):
    """seat: the seat afterwards; yes: whether the candidate has the member's vote in that term."""

    seat: Seat
    yes: bool


@kernel(implements="merging.votes.is_after_ask")
def seat_asked(seat: Seat, term: int, candidate: int) -> Vote:
    """The answer to a candidate that requests a vote in a term, or to its leader. candidate: the sender's id, > 0."""
    if term < seat.latest:
        return Vote(seat, False)
    if term == seat.latest and seat.voted != 0 and seat.voted != candidate:
        return Vote(seat, False)
    return Vote(Seat(term, candidate), True)


class Standing(NamedTuple):
    """seat: the seat afterwards; stands: whether the member stands for election."""

    seat: Seat
    stands: bool


@kernel(implements="merging.votes.stands_in")
def seat_stands(seat: Seat, member: int) -> Standing:
    """The member stands for election in the next term, unless its term has reached 2^60. member: its id, > 0."""
    if seat.latest >= 1152921504606846976:
        return Standing(seat, False)
    return Standing(Seat(seat.latest + 1, member), True)


@kernel(implements="merging.votes.counted")
def tally_step(count: int, has: bool) -> int:
    """The count with one more member. has: whether that member is counted; the count stops at 2^30."""
    if has and count < 1073741824:
        return count + 1
    return count


tally = fold(name="tally", implements="merging.votes.number_with", step=tally_step, start=0)


@kernel(implements="merging.votes.is_majority")
def is_majority(count: int, members: int) -> bool:
    """True iff the count is more than half of the members."""
    return count + count > members
