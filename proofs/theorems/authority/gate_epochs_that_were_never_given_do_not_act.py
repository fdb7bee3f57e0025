"""A command or a mode of an epoch that the gate was never in is told from one that is late, and nobody's
command of such an epoch reaches the actuators; an epoch that was given stays so."""

from cratous.core.authority.gate import Gate, epoch_given, gate_accepts, gate_offer, gate_takeover
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("gate_epoch"), c.boolean("offered"))
    sender, epoch = c.integer("sender"), c.integer("epoch")
    c.premise(c.define(authority.well_formed, gate))
    given = c.use(epoch_given, gate, epoch)
    c.show(c.same(given, c.define(authority.was_given, gate, epoch)), "its definition")
    acts = c.use(gate_accepts, gate, sender, epoch)
    c.show(c.implies(acts, given), "what acts is of an epoch that was given")
    c.show(c.use(epoch_given, gate, gate.epoch), "the present one was")
    taken, offered = c.use(gate_takeover, gate), c.use(gate_offer, gate)
    c.show(c.implies(given, c.use(epoch_given, taken, epoch)), "and stays so after a takeover")
    c.show(c.implies(given, c.use(epoch_given, offered, epoch)), "and after an offer")
