"""The actuator gate of one vehicle: who may command it, and which commands are stale.

Owner 0 is UxAS, owner 1 is ICAROUS. Each change of authority starts a new epoch; a command carries the epoch in which
it was made and is dropped in any other. ICAROUS may take over at any time; after it has offered control back, it
keeps it until the first UxAS command of the new epoch arrives, so that the vehicle is never without a commander.
Definitions: `spec.authority.gate`.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel

UXAS, ICAROUS = 0, 1


class Gate(NamedTuple):
    """owner: 0 UxAS, 1 ICAROUS; epoch: counts changes; offered: ICAROUS offers control back."""

    owner: int
    epoch: int
    offered: bool


@kernel(implements="authority.gate.is_takeover")
def gate_takeover(gate: Gate) -> Gate:
    """ICAROUS takes over (or withdraws its offer): it owns the vehicle, in a new epoch."""
    return Gate(1, gate.epoch + 1, False)


@kernel(implements="authority.gate.is_offer")
def gate_offer(gate: Gate) -> Gate:
    """ICAROUS offers control back, in a new epoch; nothing happens if it has none to offer."""
    if gate.owner == 1 and not gate.offered:
        return Gate(1, gate.epoch + 1, True)
    return gate


@kernel(
    implements="authority.gate.was_given",
    restates="which epochs there have been; that none of the others reaches the actuators is proved of it",
)
def epoch_given(gate: Gate, epoch: int) -> bool:
    """True iff the gate is or has been in this epoch; any other is forged or an error."""
    return epoch >= 0 and epoch <= gate.epoch


@kernel(
    implements="authority.gate.may_act",
    restates="the rule of the gate; what it keeps from happening is proved of it",
)
def gate_accepts(gate: Gate, sender: int, epoch: int) -> bool:
    """True iff a command of this sender and epoch may reach the actuators."""
    if epoch != gate.epoch:
        return False
    if sender == 0:
        return gate.owner == 0 or gate.offered
    return sender == 1 and gate.owner == 1


@kernel(implements="authority.gate.is_after_command")
def gate_after(gate: Gate, sender: int, epoch: int) -> Gate:
    """The gate after a command arrived: an accepted one from UxAS completes the handback."""
    if gate_accepts(gate, sender, epoch) and sender == 0:
        return Gate(0, gate.epoch, False)
    return gate


@kernel(implements="authority.gate.one_gives_way")
def gives_way(own_id: int, intruder_id: int, intruder_cooperates: bool) -> bool:
    """True iff the ownship must manoeuvre first: always, unless the intruder cooperates and has to."""
    if not intruder_cooperates:
        return True
    return own_id > intruder_id


@kernel(implements="authority.gate.handback")
def handback(offered: bool, free: bool, lasted: bool, linked: bool) -> int:
    """What ICAROUS, in command, does with its authority: 0 keep it, 1 offer it, 2 withdraw the offer.

    offered: an offer is open; free: the way back is free of predicted conflict; lasted: it has been free for the
    required time; linked: UxAS has been heard.
    """
    if offered:
        if free:
            return 0
        return 2
    if free and lasted and linked:
        return 1
    return 0
