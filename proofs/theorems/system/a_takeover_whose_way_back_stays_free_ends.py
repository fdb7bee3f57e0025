"""A takeover whose way back is free from some heartbeat on, at each, ends: at the first heartbeat after sixteen
times the least time UxAS, if it is heard then, is offered control; the UxAS end that hears of it takes the vehicle
back, whatever it believed; the command that it then sends acts, and UxAS alone commands."""

from cratous.core.authority.cycle import Cycle, cycle_flown, gate_wished
from cratous.core.authority.gate import gate_after
from cratous.core.authority.link_end import link_mode, suspended_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end
from cratous.spec.authority import cycle as instance
from cratous.spec.authority import link_end
from cratous.spec.system import authority as system
from cratous.spec.system import ending


def claim(c: Claim) -> None:
    gate, cycle = any_gate(c), any_cycle(c)
    end, suspended = any_link_end(c), c.boolean("suspended")
    heard, now, bound, least, begun = (
        c.integer(name) for name in ("heard", "now", "bound", "least", "begun")
    )
    c.premise(c.all_of(bound >= 0, least >= 0, least <= 2**56))
    c.premise(c.define(system.holds, gate, cycle, end, suspended))
    c.premise(cycle.mode == instance.AVOID)
    flown = c.use(cycle_flown, cycle, True, heard, now, bound, least)
    first = c.implies(c.negation(cycle.free), flown.cycle.free_ms == now)
    c.show(c.all_of(flown.cycle.free, first), "the wait begins when the way is free first")
    waits = c.all_of(cycle.free, cycle.free_ms == begun)
    counts = c.all_of(flown.cycle.free, flown.cycle.free_ms == begun)
    c.show(c.implies(waits, counts), "while it stays free, the wait counts on")
    after = c.use(gate_wished, gate, flown.act)
    long = c.define(ending.over, now, begun, ending.MOST_PATIENCE * least)
    linked = c.negation(c.define(link_end.too_old, heard, now, bound))
    due = c.all_of(waits, long, linked)
    c.show(c.implies(due, after.offered), "then control is offered")
    told = c.use(link_mode, end, after, False, after.epoch)
    c.show(c.implies(after.offered, told.act == link_end.TAKE_BACK), "what is heard is taken")
    held = c.use(suspended_after, suspended, told.act)
    c.show(c.implies(after.offered, c.negation(held)), "UxAS flies on")
    back = c.use(gate_after, after, 0, told.end.epoch)
    c.show(c.implies(after.offered, c.define(ending.handed_back, back)), "and commands alone")
    offers = Cycle(instance.HANDBACK, cycle.relapses, cycle.handed, cycle.handed_ms, True, begun)
    kept = c.use(
        cycle_flown, offers, True, c.integer("heard_then"), c.integer("then"), bound, least
    )
    stays = c.all_of(kept.act == instance.NOTHING, kept.cycle.mode == instance.HANDBACK)
    c.show(stays, "until then the offer stays open while the way is free")
