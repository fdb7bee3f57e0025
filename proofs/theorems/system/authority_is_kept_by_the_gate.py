"""Whichever command that was ever sent reaches the gate, late or twice: what gate, ICAROUS and the UxAS end
keep together holds once ICAROUS has taken notice at its next heartbeat; one that acts is of the present
epoch, from one who may command in it, and after one of UxAS none of ICAROUS acts in that epoch; UxAS takes
no offer that it has not heard of; every message that was ever sent remains what a message must be."""

from cratous.core.authority.cycle import cycle_begun
from cratous.core.authority.gate import Gate, gate_accepts, gate_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end
from cratous.spec.authority import gate as authority
from cratous.spec.system import authority as system


def claim(c: Claim) -> None:
    gate = any_gate(c)
    cycle = any_cycle(c)
    end, suspended = any_link_end(c), c.boolean("suspended")
    sender, epoch, now = c.integer("sender"), c.integer("command_epoch"), c.integer("now")
    c.premise(c.define(system.holds, gate, cycle, end, suspended))
    acts = c.use(gate_accepts, gate, sender, epoch)
    after = c.use(gate_after, gate, sender, epoch)
    told = c.use(gate_accepts, after, 1, after.epoch)
    noticed = c.use(cycle_begun, cycle, told, now)
    c.show(c.define(system.holds, after, noticed, end, suspended), "together")
    c.show(after.epoch == gate.epoch, "a command begins no epoch")
    by_right = c.all_of(epoch == gate.epoch, c.define(authority.may_command, gate, sender))
    c.show(c.implies(acts, by_right), "what acts is of the present epoch, by one who may command")
    c.show(c.implies(acts, c.any_of(sender == 0, sender == 1)), "and from UxAS or ICAROUS")
    again = c.integer("again")
    also = c.use(gate_accepts, after, 1, again)
    taken = c.all_of(acts, sender == 0)
    c.show(c.implies(taken, c.negation(also)), "once UxAS has commanded, nothing of ICAROUS acts")
    heard = c.define(system.takes_only_what_it_heard, gate, end, sender, acts)
    sent = c.define(system.uxas_command_holds, gate, end, epoch)
    c.show(c.implies(sent, heard), "UxAS takes no offer that it has not heard of")
    report = Gate(c.integer("report_owner"), c.integer("report_epoch"), c.boolean("report_offered"))
    other = c.integer("other_epoch")
    for text, was, stays in (
        (
            "a report",
            c.define(system.report_holds, gate, report),
            c.define(system.report_holds, after, report),
        ),
        (
            "a command of UxAS",
            c.define(system.uxas_command_holds, gate, end, other),
            c.define(system.uxas_command_holds, after, end, other),
        ),
        (
            "a command of ICAROUS",
            c.define(system.icarous_command_holds, gate, other),
            c.define(system.icarous_command_holds, after, other),
        ),
    ):
        c.show(c.implies(was, stays), text)
    c.show(c.define(system.report_holds, after, after), "what is reported then")
