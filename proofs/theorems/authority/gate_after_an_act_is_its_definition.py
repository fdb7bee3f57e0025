"""The gate after an instance's act on authority is the one that the definition describes, whatever the act and the
well-formed gate before it, and no other gate is."""

from cratous.core.authority.cycle import gate_wished
from cratous.core.authority.gate import Gate
from cratous.proofs.claim import Claim
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("epoch"), c.boolean("offered"))
    c.premise(c.define(authority.well_formed, gate))
    act, other = c.integer("act"), Gate(c.integer("o"), c.integer("e"), c.boolean("f"))
    wished = c.use(gate_wished, gate, act)
    c.show(c.define(authority_cycle.is_after_wish, gate, act, wished), "it is one")
    another = c.define(authority_cycle.is_after_wish, gate, act, other)
    c.show(c.implies(another, c.same(other, wished)), "and the only one")
