"""Who commands a vehicle: requirements on the actuator gate (G4).

Exactly one of UxAS (0) and ICAROUS (1) owns a vehicle; a command reaches the actuators only from the owner, or from
UxAS when ICAROUS has offered control back, and only in the epoch in which it was made. Every change of authority
begins a new epoch, so a late command never acts.
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


def may_act(state: State, sender: int, epoch: int) -> bool:
    """A command of this sender, made in this epoch, may reach the actuators: authority has not changed since it was
    made.
    """
    return may_command(state, sender) and epoch == state.epoch


def was_given(state: State, epoch: int) -> bool:
    """The epoch has begun: it is the first one (0), or a change so far began it."""
    return not (epoch < 0 or epoch > state.epoch)


def stale(after: State, epoch: int) -> bool:
    """No command made in this epoch can act any more, whoever sent it."""
    return not may_act(after, 0, epoch) and not may_act(after, 1, epoch)


def begins_epoch(before: State, after: State) -> bool:
    """After the change a new epoch, the next number, is current, and commands made in the previous one are stale."""
    return after.epoch == before.epoch + 1 and stale(after, before.epoch)


def is_takeover(before: State, after: State) -> bool:
    """ICAROUS alone may command, in an epoch that begins with the takeover."""
    alone = may_command(after, 1) and not may_command(after, 0)
    return well_formed(after) and alone and begins_epoch(before, after)


def is_offer(before: State, after: State) -> bool:
    """ICAROUS, which alone commanded, also permits UxAS to command and goes on until UxAS does, in an epoch that
    begins with the offer; if ICAROUS did not command alone, there is nothing to offer.
    """
    if not may_command(before, 1) or may_command(before, 0):
        return after == before
    both = may_command(after, 0) and may_command(after, 1)
    return well_formed(after) and both and begins_epoch(before, after)


def is_after_command(before: State, sender: int, epoch: int, after: State) -> bool:
    """A command that may act leaves its sender in command: UxAS alone, since its command ends an offer; ICAROUS as
    before. No command begins an epoch, and a command that may not act changes nothing.
    """
    if not may_act(before, sender, epoch) or sender != 0:
        return after == before
    alone = may_command(after, 0) and not may_command(after, 1)
    return well_formed(after) and alone and after.epoch == before.epoch


def one_gives_way(gives: bool, other_gives: bool, cooperate: bool) -> bool:
    """If both cooperate, exactly one gives way, so that neither both wait nor both manoeuvre into each other.
    Everyone gives way to an aircraft that does not cooperate.
    """
    if cooperate:
        return gives != other_gives
    return gives and other_gives


def may_offer(offered: bool, free: bool, lasted: bool, linked: bool) -> bool:
    """ICAROUS may offer control: it has not yet done so, the way back is free and has been for long enough, and UxAS
    can hear the offer.
    """
    return not offered and free and lasted and linked


def must_withdraw(offered: bool, free: bool) -> bool:
    """An open offer must be withdrawn: whoever took it would fly into a predicted conflict."""
    return offered and not free


KEEP, OFFER, WITHDRAW = 0, 1, 2
"""What an instance in command does with its authority at a heartbeat."""


def handback(offered: bool, free: bool, lasted: bool, linked: bool) -> int:
    """The act due, as a code: withdraw if required, else offer if permitted, else keep."""
    if must_withdraw(offered, free):
        return WITHDRAW
    if may_offer(offered, free, lasted, linked):
        return OFFER
    return KEEP
