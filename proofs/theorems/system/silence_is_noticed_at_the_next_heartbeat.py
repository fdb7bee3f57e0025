"""A peer that has been silent for longer than the bound is noticed at the next heartbeat, whatever was in flight:
the UxAS end says so and no longer counts the instance as heard; an instance that commands and does not hear
UxAS opens no offer, so it goes on commanding."""

from cratous.core.authority.cycle import cycle_flown, gate_wished
from cratous.core.authority.link_end import link_mode, link_sign
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end
from cratous.spec.authority import cycle as instance
from cratous.spec.authority import gate as authority
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    gate = any_gate(c)
    cycle = any_cycle(c)
    end = any_link_end(c)
    heard, now, bound, least = (c.integer(n) for n in ("heard", "now", "bound", "least"))
    says, began, free = c.boolean("says"), c.integer("began"), c.boolean("way_free")
    c.premise(c.all_of(bound >= 0, least >= 0, least <= 2**56))
    c.premise(c.define(authority.well_formed, gate))
    c.premise(c.define(instance.agree, cycle, gate))
    c.premise(c.define(link_end.too_old, heard, now, bound))
    before = c.use(link_mode, end, gate, says, began)  # whatever was in flight
    passed = c.use(link_sign, before.end, link_end.PASSED, heard, now, bound)
    c.show(c.negation(passed.end.alive), "the instance does not count as heard")
    said = c.implies(end.alive, passed.act == link_end.SAY_SILENT)
    c.show(said, "and that is said")
    flown = c.use(cycle_flown, cycle, free, heard, now, bound, least)
    after = c.use(gate_wished, gate, flown.act)
    opens = c.all_of(after.offered, c.negation(gate.offered))
    c.show(c.negation(opens), "no offer is opened")
    steers = c.define(instance.steers, cycle)
    goes_on = c.define(authority.may_command, after, 1)
    c.show(c.implies(steers, goes_on), "ICAROUS goes on commanding")
