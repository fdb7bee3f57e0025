"""Which SETMOD is believed: the one that says the next step of the vehicle's gate."""

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
"""No epoch has been heard on a connection."""


class Said(NamedTuple):
    """line: with an epoch; gate: as the line leaves it; believed: whether the line can be true."""

    line: SetMode
    gate: Gate
    believed: bool


def read(peer: Peer, line: SetMode, fresh: bool) -> Said:
    """What a SETMOD says, as the kernel `link_mode` has it. fresh: the first of a connection, which may
    say any epoch after those that are known here, up to MOST_SAID."""
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
    """True for an epoch after those of a gate that leaves room for others."""
    return not epoch_given(gate, epoch) and epoch_given(MOST_SAID, epoch)


def anew(peer: Peer) -> Peer:
    """The state on a new connection: no epoch has been received yet."""
    return replace(peer, end=peer.end._replace(epoch=NO_EPOCH))


def forgotten(peer: Peer, line: SetMode, fresh: bool) -> EpochTold | None:
    """What to tell an instance whose first mode on a connection is of an epoch that is over: it was started anew and
    does not know which epochs it has given. None for any other line."""
    if (
        not fresh
        or line.epoch is None
        or epoch_given(Gate(UXAS, line.epoch, False), peer.gate.epoch)
    ):
        return None
    has = gate_accepts(peer.gate, ICAROUS, peer.gate.epoch)
    return EpochTold("ICAROUS" if has else "UXAS", peer.gate.epoch)


def told(vehicle_id: int, line: SetMode, over: EpochTold) -> list[Out]:
    """Reply to a SETMOD of an epoch that is over: the EPOCH line, and the reason for the log."""
    text = f"vehicle {vehicle_id}: ICAROUS is in epoch {line.epoch}, which is over"
    why = Refuse("mode of an epoch that is over", f"{text}: it is told that {over.epoch} was given")
    return [why, Down(vehicle_id, (over,))]


def forged(name: str, peer: Peer, now_ms: int, why: str) -> Say:
    """What a SETMOD comes to that nobody who has the vehicle's key has sent: G4 counts it. name: of the service."""
    epoch = peer.gate.epoch
    body = lmcp.new(
        "ModeRefused", VehicleID=peer.vehicle_id, Time=now_ms, Owner="ICAROUS", Epoch=epoch,
        GateEpoch=epoch, Reason=why,
    )  # fmt: skip
    return Say(body, name)


def unknown(peer: Peer, fresh: bool) -> bool:
    """True until a restarted end has received the vehicle's current epoch."""
    return fresh and peer.gate == UNTOUCHED and not epoch_given(peer.gate, peer.end.epoch)


def begins(peer: Peer, said: Said, fresh: bool) -> bool:
    """True if this line tells a restarted end that UxAS is in command."""
    may = gate_accepts(said.gate, UXAS, said.gate.epoch)
    return said.believed and unknown(peer, fresh) and may
