"""When an automation request can be planned.

Every vehicle named is configured, and its state is known or given with the request; every task named is known and
initialised; the operating region, if named, is known with each of its zones; and there is at least one vehicle and
one task, because the plan of an empty request could not be told from a failure.
"""

from typing import NamedTuple

VEHICLE, TASK, REGION, ZONE = 1, 2, 3, 4
"""Kinds of items that a request names."""


class Found(NamedTuple):
    """The result of a pass over a request's items."""

    all_hold: bool
    a_vehicle: bool
    a_task: bool


def holds(kind: int, known: bool, ready: bool, given: bool) -> bool:
    """One item of the request satisfies its condition.

    known: configured, or defined; ready: a vehicle's state is known, a task is initialised; given: the request itself
    contains the vehicle's state.
    """
    if kind == VEHICLE:
        return known and (ready or given)
    if kind == TASK:
        return known and ready
    return kind >= REGION and kind <= ZONE and known


def found_step(found: Found, here: bool, kind: int) -> Found:
    """One more item has been checked."""
    return Found(
        found.all_hold and here, found.a_vehicle or kind == VEHICLE, found.a_task or kind == TASK
    )


def valid(found: Found) -> bool:
    """The request can be planned."""
    return found.all_hold and found.a_vehicle and found.a_task
