"""Checklists of awaited answers, and the ids by which answers are matched to their checklist.

A checklist is complete when every item on it is ticked off. Ids are allocated from one counter in blocks, one block
per request; an id belongs to the request whose block contains it.
"""

from typing import NamedTuple

LAST = 2**60
"""Ids stay below this bound."""
IDLE, AWAITS_OPTIONS, AWAITS_ROUTES, HANDED_OVER = 0, 1, 2, 3
"""Stages of the collector of one request's costs."""


def open_items(still_open: int, ticked: bool) -> int:
    """The number of open items, with one more item."""
    if ticked:
        return still_open
    return still_open + 1


def complete(still_open: int) -> bool:
    """No item is open."""
    return still_open == 0


def is_number_of_block(first: int, count: int, number: int, place: int) -> bool:
    """The id is the one at this place, counted from 0, in the block of `count` ids that begins at `first`. THERE IS a
    place.
    """
    return place >= 0 and place < count and number == first + place


class Given(NamedTuple):
    """The next free id, and how many blocks so far contain the given id."""

    free: int
    owners: int


def fits(free: int, count: int) -> bool:
    """A block of this many ids may be allocated: the count is not negative and the block does not go beyond the last
    id.
    """
    return count >= 0 and free + count <= LAST


def give_step(given: Given, count: int, number: int) -> Given:
    """A request asks for a block of ids; if the block does not fit, none is allocated."""
    if not fits(given.free, count):
        return given
    place = number - given.free
    if is_number_of_block(given.free, count, number, place):
        return Given(given.free + count, given.owners + 1)
    return Given(given.free + count, given.owners)


def owners(given: Given) -> int:
    """The number of blocks that contain the id."""
    return given.owners


def owners_due(free: int, number: int) -> int:
    """The number of blocks that must contain an id: one if it was allocated (ids begin at 1), else none."""
    if number >= 1 and number < free:
        return 1
    return 0


def collected(stage: int, all_options: bool, all_routes: bool) -> int:
    """The stage of the collector of one request, given what it has received.

    It requests routes when all options have arrived, hands over the matrix when all routes have arrived too, and does
    each once.
    """
    if stage == AWAITS_OPTIONS and all_options:
        return AWAITS_ROUTES
    if stage == AWAITS_ROUTES and all_options and all_routes:
        return HANDED_OVER
    return stage
