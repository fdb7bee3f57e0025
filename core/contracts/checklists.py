"""The route aggregator's and collector's bookkeeping: open items, blocks of ids, stages of a request.

The service stores what was received by key; these kernels decide whether a list is complete, which request an id
belongs to, and what the collector of one request does next. A list is evaluated as a whole each time, so that no
count can deviate from its contents. Definitions: `spec.contracts.checklists`.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


@kernel(supports="list_complete")
def missing_step(missing: bool, ticked: bool) -> bool:
    """Add one item of a list to whether any is missing."""
    if ticked:
        return missing
    return True


@kernel(supports="list_complete")
def missing_result(missing: bool) -> bool:
    """True iff the list is complete."""
    return not missing


list_complete = fold(
    name="list_complete",
    implements="contracts.checklists.complete",
    step=missing_step,
    start=False,
    finish=missing_result,
)


@kernel(implements="contracts.checklists.is_number_of_block")
def owns(first: int, count: int, number: int) -> bool:
    """True iff an id belongs to the block of `count` ids that begins at `first`."""
    return number >= first and number < first + count


class Owners(NamedTuple):
    """The next free id, and how many blocks so far contain the given id."""

    free: int
    owners: int


@kernel(implements="contracts.checklists.fits")
def free_after(free: int, count: int) -> int:
    """The next free id after a block of `count` was allocated from `free`; unchanged if it may not be.

    A negative count gets no block, and ids end at 2^60.
    """
    if count < 0 or count > 1152921504606846976 - free:
        return free
    return free + count


@kernel(implements="contracts.checklists.give_step")
def owners_after(o: Owners, count: int, number: int) -> Owners:
    """Allocate a block, observing one id."""
    free = free_after(o.free, count)
    if owns(o.free, free - o.free, number):
        return Owners(free, o.owners + 1)
    return Owners(free, o.owners)


@kernel(supports="owners_of")
def owners_result(o: Owners) -> int:
    """The number of blocks that contain the id."""
    return o.owners


owners_of = fold(
    name="owners_of",
    implements="contracts.checklists.owners",
    step=owners_after,
    start=Owners(1, 0),
    finish=owners_result,
)

NOTHING, ASK_ROUTES, HAND_OVER = 0, 1, 2
"""Acts of the collector of one request."""


class Collected(NamedTuple):
    """stage: 0 idle, 1 awaits options, 2 awaits routes, 3 handed over; act: what to do now."""

    stage: int
    act: int


@kernel(implements="contracts.checklists.collected")
def collector_step(stage: int, all_options: bool, all_routes: bool) -> Collected:
    """The collector's next act, given what it has received; call it again after every act."""
    if stage == 1 and all_options:
        return Collected(2, 1)
    if stage == 2 and all_options and all_routes:
        return Collected(3, 2)
    return Collected(stage, 0)
