"""What a member grants: at most one slot for each request of a vehicle, apart from what it has granted to the others.

A vehicle that wants another slot asks by a greater number, and from then on does not use what it had. A slot is used when a
majority of the members has granted it for the present request. Milliseconds.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.merging.slots import apart

NONE = 0


class Grant(NamedTuple):
    """The last that a member has granted to a vehicle. request: of which, 0 nothing yet; time: at the fix."""

    request: int
    time: int


class Answer(NamedTuple):
    """grant: afterwards; yes: what was proposed is."""

    grant: Grant
    yes: bool


def leaves_room(request: int, time: int, asked: int, separation: int) -> bool:
    """A time is apart from what is granted to another vehicle, if anything is."""
    return request == NONE or apart(asked, time, separation)


def all_leave_room(so_far: bool, request: int, time: int, asked: int, separation: int) -> bool:
    """The others so far leave room, and one more does."""
    return so_far and leaves_room(request, time, asked, separation)


def is_after_proposal(before: Grant, asked: Grant, room: bool, after: Answer) -> bool:
    """A slot is granted where it is for a newer request than any before, with room; what has been granted is granted still;
    anything else changes nothing."""
    if asked.request > before.request and room:
        return after == Answer(asked, True)
    again = asked == before and asked.request != NONE
    return after == Answer(before, again)


def used(current: int, request: int, granted: bool) -> bool:
    """A slot counts for its vehicle: it is for the present request, and a member has granted it."""
    return granted and current == request
