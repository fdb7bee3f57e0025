"""Whatever numbers stand in a gate, also where its owner is neither UxAS nor ICAROUS: a command passes exactly when its
sender may command and its epoch is the present one, and only ICAROUS, which alone commands, opens an offer."""

from cratous.core.authority.gate import gate_accepts, gate_offer
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_gate
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = any_gate(c)
    sender, epoch = c.integer("sender"), c.integer("command_epoch")
    passes = c.use(gate_accepts, gate, sender, epoch)
    c.show(c.same(passes, c.define(authority.may_act, gate, sender, epoch)), "who passes")
    nobody = c.all_of(gate.owner != 0, gate.owner != 1, c.negation(gate.offered))
    c.show(c.implies(nobody, c.negation(passes)), "for an owner that there is not nobody acts")
    offer = c.use(gate_offer, gate)
    alone = c.all_of(
        c.define(authority.may_command, gate, 1),
        c.negation(c.define(authority.may_command, gate, 0)),
    )
    c.show(c.same(c.negation(c.same(offer, gate)), alone), "who opens an offer")
