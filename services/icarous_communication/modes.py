"""Validation of SETMOD lines: accepted if they state the next transition of the vehicle's gate."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cratous.bridge import lmcp
from cratous.bridge.text_protocol import EpochTold, SetMode
from cratous.core.authority.gate import (
    ICAROUS,
    UXAS,
    Gate,
    epoch_given,
    gate_accepts,
    gate_offer,
    gate_takeover,
)
from cratous.core.authority.link_end import link_mode
from cratous.services.flight.link_lines import MOST_SAID
from cratous.services.flight.link_peers import UNTOUCHED, Peer
from cratous.services.flight.messages import Down, Say
from cratous.services.icarous_communication.state import Out, Refuse
from cratous.spec.authority.link_end import OVERTAKEN, REFUSED

NO_EPOCH = -1
"""No epoch has been received on the connection."""


class Said(NamedTuple):
    """line: with its epoch; gate: the gate after the line; believed: whether the line is consistent with the
    gate.
    """

    line: SetMode
    gate: Gate
    believed: bool


def read(peer: Peer, line: SetMode, fresh: bool) -> Said:
    """Interpret a SETMOD, as the kernel `link_mode` decides.

    fresh: the first on a connection, which may carry any later epoch than the known ones, up to MOST_SAID.
    """
    active, gate = line.mode == "ACTIVE", peer.gate
    epoch_told = gate.epoch if line.epoch is None else line.epoch
    if fresh and _after(gate, epoch_told):
        gates = [Gate(ICAROUS if active else UXAS, epoch_told, False)]
    else:
        gates = [gate, gate_takeover(gate) if active else gate_offer(gate)]
    for one in gates:
        epoch = one.epoch if line.epoch is None else line.epoch
        if link_mode(peer.end, one, active, epoch).act not in (OVERTAKEN, REFUSED):
            return Said(SetMode(line.mode, epoch), one, True)
    return Said(SetMode(line.mode, epoch_told), gate, False)


def _after(gate: Gate, epoch: int) -> bool:
    """Whether an epoch is later than those of a gate and leaves room for further ones."""
    return not epoch_given(gate, epoch) and epoch_given(MOST_SAID, epoch)


def anew(peer: Peer) -> Peer:
    """The state on a new connection: no epoch has been received yet."""
    return replace(peer, end=peer.end._replace(epoch=NO_EPOCH))


def forgotten(peer: Peer, line: SetMode, fresh: bool) -> EpochTold | None:
    """The EPOCH line for an instance whose first mode on a connection carries a past epoch: it was restarted
    and does not know which epochs it has issued. None for any other line.
    """
    if (
        not fresh
        or line.epoch is None
        or epoch_given(Gate(UXAS, line.epoch, False), peer.gate.epoch)
    ):
        return None
    has = gate_accepts(peer.gate, ICAROUS, peer.gate.epoch)
    return EpochTold("ICAROUS" if has else "UXAS", peer.gate.epoch)


def told(vehicle_id: int, line: SetMode, over: EpochTold) -> list[Out]:
    """Reply to a SETMOD of a past epoch: the EPOCH line, and the reason for the log."""
    text = f"vehicle {vehicle_id}: ICAROUS is in epoch {line.epoch}, which is over"
    why = Refuse("mode of an epoch that is over", f"{text}: it is told that {over.epoch} was given")
    return [why, Down(vehicle_id, (over,))]


def forged(name: str, peer: Peer, now_ms: int, why: str) -> Say:
    """A ModeRefused for a SETMOD without a valid authentication tag, which monitor G4 counts. name: of the
    service.
    """
    epoch = peer.gate.epoch
    body = lmcp.new(
        "ModeRefused", VehicleID=peer.vehicle_id, Time=now_ms, Owner="ICAROUS", Epoch=epoch,
        GateEpoch=epoch, Reason=why,
    )  # fmt: skip
    return Say(body, name)


def unknown(peer: Peer, fresh: bool) -> bool:
    """Whether a restarted end has not received the vehicle's epoch yet."""
    return fresh and peer.gate == UNTOUCHED and not epoch_given(peer.gate, peer.end.epoch)


def begins(peer: Peer, said: Said, fresh: bool) -> bool:
    """Whether this line tells a restarted end that UxAS is in command."""
    may = gate_accepts(said.gate, UXAS, said.gate.epoch)
    return said.believed and unknown(peer, fresh) and may
