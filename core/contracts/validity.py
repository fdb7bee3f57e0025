"""Whether an automation request can be planned, and what is wrong with an item that is not ready.

Definitions: `spec.contracts.validity`.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel

FINE, UNKNOWN, NOT_READY, NO_SUCH_KIND = 0, 1, 2, 3
"""Possible faults of one item that a request names."""


class Faults(NamedTuple):
    """Whether a fault, a vehicle and a task have been found."""

    fault: bool
    vehicle: bool
    task: bool


@kernel(implements="contracts.validity.holds")
def item_fault(kind: int, known: bool, ready: bool, given: bool) -> int:
    """The fault of one item that a request names: 0 none, 1 unknown, 2 not ready.

    kind: 1 vehicle, 2 task, 3 region, 4 zone (3 is the fault of any other); known: configured or defined; ready:
    state known, or initialised; given: the request itself contains the vehicle's state.
    """
    if kind < 1 or kind > 4:
        return 3
    if not known:
        return 1
    if kind == 1 and not ready and not given:
        return 2
    if kind == 2 and not ready:
        return 2
    return 0


@kernel(implements="contracts.validity.found_step")
def faults_step(faults: Faults, kind: int, known: bool, ready: bool, given: bool) -> Faults:
    """Add one item to what has been found."""
    return Faults(
        faults.fault or item_fault(kind, known, ready, given) != 0,
        faults.vehicle or kind == 1,
        faults.task or kind == 2,
    )


@kernel(implements="contracts.validity.valid")
def faults_result(faults: Faults) -> bool:
    """True iff there was no fault, and a vehicle and a task."""
    return not faults.fault and faults.vehicle and faults.task


request_valid = fold(
    name="request_valid",
    implements="contracts.validity.valid",
    step=faults_step,
    start=Faults(False, False, False),
    finish=faults_result,
)
