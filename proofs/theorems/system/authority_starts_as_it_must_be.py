"""At the start UxAS alone commands in epoch 0, ICAROUS watches, the UxAS end knows it, and what the three
keep together holds; whatever is sent then is what a message must be."""

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.gate import Gate, gate_accepts
from cratous.core.authority.link_end import LinkEnd
from cratous.proofs.claim import Claim
from cratous.spec.authority import gate as authority
from cratous.spec.system import authority as system


def claim(c: Claim) -> None:
    gate, end = Gate(0, 0, False), LinkEnd(False, 0, c.boolean("alive"))
    cycle = Cycle(0, 0, False, 0, False, 0)
    c.show(c.define(system.holds, gate, cycle, end, False), "together")
    c.show(c.define(system.report_holds, gate, gate), "what is reported")
    c.show(c.define(system.uxas_command_holds, gate, end, gate.epoch), "what UxAS sends")
    sender, epoch = c.integer("sender"), c.integer("epoch")
    passes = c.use(gate_accepts, gate, sender, epoch)
    first = c.all_of(sender == 0, epoch == 0)
    c.show(c.implies(passes, first), "nothing else acts")
    c.show(c.define(authority.may_command, gate, 0), "UxAS commands")
