"""At the actuator gate a command passes exactly when its sender may command in this state and its
epoch is the present one; after an accepted command its sender owns the vehicle and the other cannot
command it, unless ICAROUS has offered control back; so UxAS and ICAROUS never both own it."""

from cratous.core.authority.gate import Gate, gate_accepts, gate_after
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("epoch"), c.boolean("offered"))
    sender, epoch = c.integer("sender"), c.integer("command_epoch")
    c.premise(c.define(authority.well_formed, gate))
    accepted = c.use(gate_accepts, gate, sender, epoch)
    allowed = c.define(authority.may_command, gate, sender)
    c.show(c.same(accepted, c.all_of(allowed, epoch == gate.epoch)), "who passes")
    c.show(c.same(accepted, c.define(authority.may_act, gate, sender, epoch)), "it may act")
    after = c.use(gate_after, gate, sender, epoch)
    c.show(c.define(authority.is_after_command, gate, sender, epoch, after), "what it changes")
    others = Gate(c.integer("other_owner"), c.integer("other_epoch"), c.boolean("other_offered"))
    another = c.define(authority.is_after_command, gate, sender, epoch, others)
    c.show(c.implies(another, c.same(others, after)), "and it changes nothing else")
    c.show(c.define(authority.well_formed, after), "the gate stays well formed")
    c.show(c.implies(accepted, after.owner == sender), "who commands owns")
    c.show(c.implies(c.negation(accepted), c.same(after, gate)), "a dropped one changes nothing")
    c.show(after.epoch == gate.epoch, "a command begins no epoch")
    other = c.use(gate_accepts, after, 1 - sender, epoch)
    closed = c.any_of(sender == 0, c.negation(gate.offered))
    c.show(
        c.implies(c.all_of(accepted, closed), c.negation(other)),
        "the other cannot command after it, unless ICAROUS has offered control back",
    )
