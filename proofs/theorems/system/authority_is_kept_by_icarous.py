"""Whatever an ICAROUS instance does at a heartbeat, be a conflict foreseen or the way back free, in whatever
state the link: what gate, ICAROUS and the UxAS end keep together holds, no epoch goes back, every message that
was ever sent remains what a message must be, and a command that was made before a change of authority does not act."""

from cratous.core.authority.cycle import cycle_flown, cycle_watched, gate_wished
from cratous.core.authority.gate import Gate, gate_accepts
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end, any_times
from cratous.spec.authority import cycle as instance
from cratous.spec.system import authority as system


def claim(c: Claim) -> None:
    gate = any_gate(c)
    cycle = any_cycle(c)
    end, suspended = any_link_end(c), c.boolean("suspended")
    foreseen, free = c.boolean("foreseen"), c.boolean("way_free")
    now, soon, heard, bound, least = any_times(c)
    report = Gate(c.integer("report_owner"), c.integer("report_epoch"), c.boolean("report_offered"))
    sent, sender = c.integer("sent_epoch"), c.integer("sender")
    c.premise(c.define(system.holds, gate, cycle, end, suspended))
    watched = c.use(cycle_watched, cycle, foreseen, now, soon)
    flown = c.use(cycle_flown, cycle, free, heard, now, bound, least)
    for text, does in (("watching", watched), ("flying", flown)):
        after = c.use(gate_wished, gate, does.act)
        c.show(c.define(system.holds, after, does.cycle, end, suspended), f"{text}: together")
        c.show(after.epoch >= gate.epoch, f"{text}: no epoch goes back")
        reported = c.define(system.report_holds, gate, report)
        still = c.define(system.report_holds, after, report)
        c.show(c.implies(reported, still), f"{text}: a report")
        c.show(c.define(system.report_holds, after, after), f"{text}: what is reported then")
        by_uxas = c.define(system.uxas_command_holds, gate, end, sent)
        still_by_uxas = c.define(system.uxas_command_holds, after, end, sent)
        c.show(c.implies(by_uxas, still_by_uxas), f"{text}: a command of UxAS")
        by_icarous = c.define(system.icarous_command_holds, gate, sent)
        still_by_icarous = c.define(system.icarous_command_holds, after, sent)
        c.show(c.implies(by_icarous, still_by_icarous), f"{text}: a command of ICAROUS")
        steers = c.define(instance.steers, does.cycle)
        made = c.define(system.icarous_command_holds, after, after.epoch)
        c.show(c.implies(steers, made), f"{text}: what ICAROUS sends then")
        acts = c.use(gate_accepts, after, sender, sent)
        late = c.all_of(by_uxas, after.epoch > gate.epoch)
        c.show(c.implies(late, c.negation(acts)), f"{text}: what was made before does not act")
