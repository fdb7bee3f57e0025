"""An ICAROUS instance and its gate agree on who commands: after each heartbeat the instance steers exactly
if the gate lets it and offers exactly if an offer is open; so every velocity that it sends passes its gate,
and when UxAS has taken an offer the instance lets go at the next heartbeat."""

from cratous.core.authority.cycle import cycle_begun, cycle_flown, cycle_watched, gate_wished
from cratous.core.authority.gate import Gate, gate_accepts, gate_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_times
from cratous.spec.authority import cycle as authority_cycle
from cratous.spec.authority import gate as authority


def claim(c: Claim) -> None:
    gate = Gate(c.integer("owner"), c.integer("epoch"), c.boolean("offered"))
    cycle = any_cycle(c)
    now, soon, heard, bound, least = any_times(c)
    foreseen, free = c.boolean("foreseen"), c.boolean("way_free")
    c.premise(c.define(authority.well_formed, gate))
    c.premise(c.define(authority_cycle.agree, cycle, gate))  # at the start, and after each step

    sender, epoch = c.integer("sender"), c.integer("command_epoch")
    commanded = c.use(gate_after, gate, sender, epoch)  # since the last heartbeat
    commands = c.use(gate_accepts, commanded, 1, commanded.epoch)
    begun = c.use(cycle_begun, cycle, commands, now)
    c.show(c.define(authority_cycle.agree, begun, commanded), "when a heartbeat begins")

    watched = c.use(cycle_watched, cycle, foreseen, now, soon)
    flown = c.use(cycle_flown, cycle, free, heard, now, bound, least)
    for text, does in (("watching", watched), ("flying", flown)):
        after = c.use(gate_wished, gate, does.act)
        c.show(c.define(authority_cycle.is_after_wish, gate, does.act, after), f"{text}: the gate")
        c.show(c.define(authority.well_formed, after), f"{text}: one commander")
        c.show(c.define(authority_cycle.agree, does.cycle, after), f"{text}: they agree")
        passes = c.use(gate_accepts, after, 1, after.epoch)
        steers = c.define(authority_cycle.steers, does.cycle)
        c.show(c.same(steers, passes), f"{text}: what it steers passes the gate")
        c.show(after.epoch >= gate.epoch, f"{text}: no epoch comes back")
