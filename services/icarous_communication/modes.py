"""Which SETMOD is believed: the one that says the next step of the vehicle's gate."""

from __future__ import annotations

from typing import NamedTuple

from cratous.bridge.text_protocol import SetMode
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_offer, gate_takeover
from cratous.core.authority.link_end import link_mode
from cratous.services.flight.link_end import Peer
from cratous.spec.authority.link_end import OVERTAKEN, REFUSED


class Said(NamedTuple):
    """line: with an epoch; gate: as the line leaves it; believed: whether the line can be true."""

    line: SetMode
    gate: Gate
    believed: bool


def read(peer: Peer, line: SetMode, fresh: bool) -> Said:
    """What a SETMOD says, as the kernel `link_mode` has it. fresh: the first of a connection, which may
    say any epoch."""
    active, gate = line.mode == "ACTIVE", peer.gate
    if fresh and line.epoch is not None:
        gates = [Gate(ICAROUS if active else UXAS, line.epoch, False)]
    else:
        gates = [gate, gate_takeover(gate) if active else gate_offer(gate)]
    for one in gates:
        epoch = one.epoch if line.epoch is None else line.epoch
        if link_mode(peer.end, one, active, epoch).act not in (OVERTAKEN, REFUSED):
            return Said(SetMode(line.mode, epoch), one, True)
    return Said(SetMode(line.mode, gate.epoch if line.epoch is None else line.epoch), gate, False)
