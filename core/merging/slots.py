"""Arrival slots at a merge fix, from each vehicle's earliest and latest arrival. Definitions: `spec.merging.slots`.

In a given order each vehicle gets the earliest time in its window after those before it (`in_line`); no assignment
in that order gives any vehicle less delay. `slots_of` searches the orders, beginning with that of the earliest
arrivals, for the first in which every vehicle has a slot; if there is none, no assignment exists.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cratous.core.kernel import driver, fold, kernel


class Line(NamedTuple):
    """free: time from which the fix is free [ms]; fits: each vehicle so far has a slot; time: of the last slot [ms]."""

    free: int
    fits: bool
    time: int


@kernel(implements="merging.slots.is_next_slot", nonnegative=("separation",))
def slot_step(line: Line, earliest: int, latest: int, separation: int) -> Line:
    """The line with the slot of one more vehicle.

    earliest, latest: its window at the fix [ms]; separation: least time between two slots [ms], >= 0. Once a vehicle
    has no slot, the line no longer changes.
    """
    time = max(line.free, earliest)
    if not line.fits or time > latest:
        return Line(line.free, False, line.time)
    return Line(time + separation, True, time)


in_line = fold(
    name="in_line", implements="merging.slots.follows", step=slot_step, start=Line(0, True, 0)
)


class Wanted(NamedTuple):
    """The window of a vehicle at the fix [ms]; for a vehicle with a slot, that time only."""

    vehicle_id: int
    earliest: int
    latest: int


Slots = tuple[tuple[int, int], ...]
"""Vehicle ids and times [ms], in the order of passing the fix."""
MOST = 8
"""Largest number of vehicles whose orders are searched."""


@driver(checked_by=("slot_step",))
def slots_of(wanted: Sequence[Wanted], separation: int) -> Slots | None:
    """A slot for each vehicle, in the first order in which all fit, beginning with that of the earliest arrivals.

    separation: least time between two slots [ms], >= 0. None if no assignment exists. ValueError for more than
    MOST vehicles.
    """
    if len(wanted) > MOST:
        raise ValueError(f"{len(wanted)} vehicles at one fix, {MOST} at most")
    first = sorted(wanted, key=lambda one: (one.earliest, one.latest, one.vehicle_id))
    return next(_orders((), Line(0, True, 0), first, separation), None)


def _orders(found: Slots, line: Line, left: list[Wanted], separation: int) -> Iterator[Slots]:
    if not left:
        yield found
    for k, (vehicle_id, earliest, latest) in enumerate(left):
        after = slot_step(line, earliest, latest, separation)
        if after.fits:
            slot = (vehicle_id, after.time)
            yield from _orders((*found, slot), after, left[:k] + left[k + 1 :], separation)
