"""When an automation request can be planned at all.

Every vehicle that it names is configured, and its state is known or given with the request; every
task that it names is known and has initialised itself; its operating region, if it names one, is
known with each of its zones; and there is at least one vehicle and one task, because an empty
request has no plan that could be told from a failure.
"""

from typing import NamedTuple

VEHICLE, TASK, REGION, ZONE = 1, 2, 3, 4
"""Kinds of things that a request names."""


class Found(NamedTuple):
    """What a pass over a request's things has found."""

    all_hold: bool
    a_vehicle: bool
    a_task: bool


def holds(kind: int, known: bool, ready: bool, given: bool) -> bool:
    """One thing that the request names is as it must be.

    known: configured, or defined; ready: a vehicle's state is known, a task is initialised;
    given: the request brings the vehicle's state itself.
    """
    if kind == VEHICLE:
        return known and (ready or given)
    if kind == TASK:
        return known and ready
    return kind >= REGION and kind <= ZONE and known


def found_step(found: Found, here: bool, kind: int) -> Found:
    """One more thing has been looked at."""
    return Found(
        found.all_hold and here, found.a_vehicle or kind == VEHICLE, found.a_task or kind == TASK
    )


def valid(found: Found) -> bool:
    """The request can be planned."""
    return found.all_hold and found.a_vehicle and found.a_task
