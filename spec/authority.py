"""Who commands a vehicle: what must be true of the actuator gate (G4).

Exactly one of UxAS (0) and ICAROUS (1) owns a vehicle; a command reaches the actuators only from
the owner, or from UxAS when ICAROUS has offered control back, and only in the epoch in which it
was made. Every change of authority begins a new epoch, so a late command never acts.
"""

from typing import NamedTuple


class State(NamedTuple):
    """owner: 0 UxAS, 1 ICAROUS; epoch: number of changes so far; offered: a handback is open."""

    owner: int
    epoch: int
    offered: bool


def well_formed(state: State) -> bool:
    """There is exactly one owner, and only ICAROUS can have an offer open."""
    one_owner = state.owner == 0 or state.owner == 1
    return one_owner and state.epoch >= 0 and (not state.offered or state.owner == 1)


def may_command(state: State, sender: int) -> bool:
    """The sender may command in this state: it owns the vehicle, or control is offered to it."""
    if sender == 0:
        return state.owner == 0 or state.offered
    return sender == 1 and state.owner == 1
