"""Arrival slots at a merge fix, from the earliest and the latest arrival of each vehicle. Definitions: `spec.merging.slots`.

In one order each vehicle gets the first time that its window and those before it leave (`in_line`): then nobody of that
order can have less delay. `slots_of` looks through orders, the one of the earliest arrivals first, to the first in
which everybody has a slot; where there is none, no assignment exists.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cratous.core.kernel import driver, fold, kernel


class Line(NamedTuple):
    """free: from when on the fix is free [ms]; fits: each so far has a slot; time: of the last one [ms]."""

    free: int
    fits: bool
    time: int


@kernel(implements="merging.slots.is_next_slot", nonnegative=("separation",))
def slot_step(line: Line, earliest: int, latest: int, separation: int) -> Line:
    """With the slot of one more vehicle, which can be there from earliest until latest [ms]. separation: between two
    of them [ms], >= 0. Once one has none the line stays as it is."""
    time = max(line.free, earliest)
    if not line.fits or time > latest:
        return Line(line.free, False, line.time)
    return Line(time + separation, True, time)


in_line = fold(
    name="in_line", implements="merging.slots.follows", step=slot_step, start=Line(0, True, 0)
)


class Wanted(NamedTuple):
    """When a vehicle can be at the fix [ms]: a slot that it has is the only time."""

    vehicle_id: int
    earliest: int
    latest: int


Slots = tuple[tuple[int, int], ...]
"""Vehicle and time [ms], in order."""
MOST = 8
"""Orders of more vehicles are not looked through."""


@driver(checked_by=("slot_step",))
def slots_of(wanted: Sequence[Wanted], separation: int) -> Slots | None:
    """A slot for each, in the first order in which there is one, orders by earliest arrival first; None where no
    assignment exists. ValueError for more than MOST vehicles."""
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
