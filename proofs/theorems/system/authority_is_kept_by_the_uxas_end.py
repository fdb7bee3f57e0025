"""Whatever SETMOD line reaches the UxAS end, late, twice or forged, with whatever report of the gate that was
ever sent, and whatever sign of life or silence: what gate, ICAROUS and the UxAS end keep together holds
afterwards, the epoch that UxAS believes in does not go back, and what UxAS then sends is what a message must be."""

from cratous.core.authority.gate import Gate
from cratous.core.authority.link_end import (
    link_mode,
    link_sign,
    suspended_after,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end
from cratous.spec.system import authority as system


def claim(c: Claim) -> None:
    gate = any_gate(c)
    cycle = any_cycle(c)
    end, suspended = any_link_end(c), c.boolean("suspended")
    report = Gate(c.integer("report_owner"), c.integer("report_epoch"), c.boolean("report_offered"))
    says, began = c.boolean("says"), c.integer("began")
    c.premise(c.define(system.holds, gate, cycle, end, suspended))
    c.premise(c.define(system.report_holds, gate, report))
    moved = c.use(link_mode, end, report, says, began)
    after = c.use(suspended_after, suspended, moved.act)
    c.show(c.define(system.holds, gate, cycle, moved.end, after), "after a mode")
    c.show(moved.end.epoch >= end.epoch, "no epoch goes back")
    sent = c.define(system.uxas_command_holds, gate, moved.end, moved.end.epoch)
    c.show(sent, "a command of the epoch that UxAS believes in")
    other = c.integer("other_epoch")
    was = c.define(system.uxas_command_holds, gate, end, other)
    stays = c.define(system.uxas_command_holds, gate, moved.end, other)
    c.show(c.implies(was, stays), "a command that was sent before")
    event, heard, now, bound = (c.integer(n) for n in ("event", "heard", "now", "bound"))
    c.premise(bound >= 0)
    sign = c.use(link_sign, end, event, heard, now, bound)
    c.show(
        c.define(system.holds, gate, cycle, sign.end, suspended), "after a sign of life, or none"
    )
