"""What a member grants: at most one slot for each request of a vehicle, apart from the slots granted to the others.

A vehicle that needs another slot makes a request with a greater number, and no longer uses its earlier slot. A slot is
used once a majority of the members has granted it for the present request. Times are in milliseconds.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.merging.slots import apart

NONE = 0


class Grant(NamedTuple):
    """The last slot that a member granted to a vehicle. request: its number, 0 for none yet; time: at the fix."""

    request: int
    time: int


class Answer(NamedTuple):
    """grant: the grant afterwards; yes: whether the proposed slot is granted."""

    grant: Grant
    yes: bool


def leaves_room(request: int, time: int, asked: int, separation: int) -> bool:
    """The time `asked` is apart from the slot granted to another vehicle, if there is one."""
    return request == NONE or apart(asked, time, separation)


def all_leave_room(so_far: bool, request: int, time: int, asked: int, separation: int) -> bool:
    """The other vehicles so far leave room, and so does one more."""
    return so_far and leaves_room(request, time, asked, separation)


def is_after_proposal(before: Grant, asked: Grant, room: bool, after: Answer) -> bool:
    """A slot with room is granted to a newer request than any granted before; a slot already granted is confirmed.
    Any other proposal is refused. Only a newly granted slot changes the grant.
    """
    if asked.request > before.request and room:
        return after == Answer(asked, True)
    again = asked == before and asked.request != NONE
    return after == Answer(before, again)


def used(current: int, request: int, granted: bool) -> bool:
    """A slot is valid for its vehicle: it is for the present request, and has been granted."""
    return granted and current == request
