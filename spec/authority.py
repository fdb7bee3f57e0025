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


def may_offer(offered: bool, free: bool, lasted: bool, linked: bool) -> bool:
    """ICAROUS may offer control: it has not yet, the way back is free and has been for long enough,
    and UxAS can hear the offer."""
    return not offered and free and lasted and linked


def must_withdraw(offered: bool, free: bool) -> bool:
    """An open offer must be withdrawn: whoever took it would fly into a predicted conflict."""
    return offered and not free


KEEP, OFFER, WITHDRAW = 0, 1, 2
"""What an instance that commands does with its authority at a heartbeat."""


def handback(offered: bool, free: bool, lasted: bool, linked: bool) -> int:
    """What is due, by code: withdraw what must be withdrawn, offer what may be offered, else keep."""
    if must_withdraw(offered, free):
        return WITHDRAW
    if may_offer(offered, free, lasted, linked):
        return OFFER
    return KEEP
