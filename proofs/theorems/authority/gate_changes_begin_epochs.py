"""ICAROUS can take over in any state; takeover and offer begin a new epoch, so that every earlier
command is stale; an offer leaves ICAROUS in command until UxAS answers, and only then."""

from cratous.core.authority.gate import Gate, gate_accepts, gate_offer, gate_takeover
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("epoch"), c.boolean("offered"))
    sender, epoch = c.integer("sender"), c.integer("command_epoch")
    c.premise(c.define(authority.well_formed, gate))
    other = Gate(c.integer("other_owner"), c.integer("other_epoch"), c.boolean("other_offered"))
    taken = c.use(gate_takeover, gate)
    c.show(c.define(authority.is_takeover, gate, taken), "it is a takeover")
    another = c.define(authority.is_takeover, gate, other)
    c.show(c.implies(another, c.same(other, taken)), "there is one takeover, and no other")
    c.show(c.define(authority.well_formed, taken), "a takeover is well formed")
    c.show(c.all_of(taken.owner == 1, c.negation(taken.offered)), "ICAROUS commands alone")
    c.show(c.negation(c.define(authority.may_command, taken, 0)), "UxAS may not command")
    c.show(taken.epoch > gate.epoch, "in a new epoch")
    stale = c.use(gate_accepts, taken, sender, epoch)
    c.show(c.implies(epoch <= gate.epoch, c.negation(stale)), "earlier commands are stale")
    offer = c.use(gate_offer, gate)
    c.show(c.define(authority.is_offer, gate, offer), "it is an offer")
    another = c.define(authority.is_offer, gate, other)
    c.show(c.implies(another, c.same(other, offer)), "there is one offer, and no other")
    c.show(c.define(authority.well_formed, offer), "an offer is well formed")
    c.show(c.same(offer.owner, gate.owner), "an offer changes no owner")
    opened = c.all_of(gate.owner == 1, c.negation(gate.offered))
    c.show(c.implies(opened, c.all_of(offer.offered, offer.epoch > gate.epoch)), "it opens")
    c.show(c.implies(c.negation(opened), c.same(offer, gate)), "else nothing happens")
    both = c.all_of(
        c.define(authority.may_command, offer, 0), c.define(authority.may_command, offer, 1)
    )
    c.show(c.implies(opened, both), "ICAROUS goes on until UxAS answers")
