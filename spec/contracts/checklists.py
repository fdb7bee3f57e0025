"""Checklists of answers that are awaited, and the ids by which answers find the list they belong to.

A list is complete when every item on it is ticked off. Ids are given out from one counter in
blocks, a block for each request; an id belongs to the request in whose block it lies.
"""

from typing import NamedTuple

LAST = 2**60
"""Ids end here."""
IDLE, AWAITS_OPTIONS, AWAITS_ROUTES, HANDED_OVER = 0, 1, 2, 3
"""Stages of the collector of one request's costs."""


def open_items(still_open: int, ticked: bool) -> int:
    """How many items are still open, with one item more."""
    if ticked:
        return still_open
    return still_open + 1


def complete(still_open: int) -> bool:
    """Of all items none is open."""
    return still_open == 0


def is_number_of_block(first: int, count: int, number: int, place: int) -> bool:
    """The id is the one at this place, from 0 on, of the `count` ids that are given out from `first`
    on. THERE IS a place."""
    return place >= 0 and place < count and number == first + place


class Given(NamedTuple):
    """The next free id, and how many blocks so far hold the id that is looked at."""

    free: int
    owners: int


def fits(free: int, count: int) -> bool:
    """A block of so many ids may be given out: not of fewer than none, nor beyond the last id."""
    return count >= 0 and free + count <= LAST


def give_step(given: Given, count: int, number: int) -> Given:
    """A request asks for a block of ids; one that does not fit gets none."""
    if not fits(given.free, count):
        return given
    place = number - given.free
    if is_number_of_block(given.free, count, number, place):
        return Given(given.free + count, given.owners + 1)
    return Given(given.free + count, given.owners)


def owners(given: Given) -> int:
    """How many blocks hold the id."""
    return given.owners


def owners_due(free: int, number: int) -> int:
    """In how many blocks an id has to lie: one if it was given out (they begin at 1), else none."""
    if number >= 1 and number < free:
        return 1
    return 0


def collected(stage: int, all_options: bool, all_routes: bool) -> int:
    """Where the collector of one request stands with what it has.

    It asks for routes when all options are there, hands the matrix over when all routes are there
    too, and does neither twice.
    """
    if stage == AWAITS_OPTIONS and all_options:
        return AWAITS_ROUTES
    if stage == AWAITS_ROUTES and all_options and all_routes:
        return HANDED_OVER
    return stage
