"""The gate's epoch counts its changes: a takeover adds one, an offer that opens adds one, and nothing
else does, so no epoch is skipped and none is used twice."""

from cratous.core.authority.gate import Gate, gate_after, gate_offer, gate_takeover
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("epoch"), c.boolean("offered"))
    sender, epoch = c.integer("sender"), c.integer("command_epoch")
    c.premise(c.define(authority.well_formed, gate))
    c.show(c.use(gate_takeover, gate).epoch == gate.epoch + 1, "a takeover adds one")
    opens = c.all_of(gate.owner == 1, c.negation(gate.offered))
    offer = c.use(gate_offer, gate)
    c.show(offer.epoch == c.when(opens, gate.epoch + 1, gate.epoch), "an offer that opens adds one")
    c.show(c.use(gate_after, gate, sender, epoch).epoch == gate.epoch, "a command adds none")
