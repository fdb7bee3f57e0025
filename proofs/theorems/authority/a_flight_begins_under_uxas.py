"""A flight begins well formed, with UxAS in command and no offer open: in epoch 0 the gate lets UxAS
through and not ICAROUS, until ICAROUS takes over."""

from cratous.core.authority.gate import Gate, gate_accepts, gate_takeover
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    start = Gate(0, 0, False)
    c.show(c.define(authority.well_formed, start), "the start is well formed")
    c.show(c.use(gate_accepts, start, 0, 0), "UxAS commands")
    c.show(c.negation(c.use(gate_accepts, start, 1, 0)), "ICAROUS does not")
    taken = c.use(gate_takeover, start)
    c.show(c.use(gate_accepts, taken, 1, 1), "after a takeover it does")
    c.show(c.negation(c.use(gate_accepts, taken, 0, 1)), "and UxAS does not")
