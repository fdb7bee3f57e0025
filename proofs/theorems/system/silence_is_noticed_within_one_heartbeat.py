"""Silence of more than the bound is noticed at most one period later, on both ends, whatever was in flight, and for as
long as it lasts: the UxAS end says so and no longer counts the instance as heard; an instance that commands opens
no offer at that heartbeat or a later one, and goes on commanding."""

from cratous.core.authority.cycle import cycle_flown, gate_wished
from cratous.core.authority.link_end import link_mode, link_sign
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_cycle, any_gate, any_link_end
from cratous.spec.authority import cycle as instance
from cratous.spec.authority import gate as authority
from cratous.spec.authority import link_end


def claim(c: Claim) -> None:
    gate, cycle = any_gate(c), any_cycle(c)
    end = any_link_end(c)
    heard, before, now, later = (c.integer(n) for n in ("heard", "before", "now", "later"))
    bound, period, least = c.integer("bound"), c.integer("period"), c.integer("least")
    says, began, free = c.boolean("says"), c.integer("began"), c.boolean("way_free")
    c.premise(c.all_of(bound >= 0, period >= 0, least >= 0, least <= 2**56))
    c.premise(c.define(authority.well_formed, gate))
    c.premise(c.define(instance.agree, cycle, gate))
    for instant in (now, later):
        c.premise(c.define(link_end.too_old, heard, instant, bound))
    # at the heartbeat before, not more than a period ago, the peer was heard
    was = c.all_of(
        now <= before + period, c.negation(c.define(link_end.too_old, heard, before, bound))
    )
    c.show(c.implies(was, now <= heard + bound + period), "at most one period after the bound")
    moved = c.use(link_mode, end, gate, says, began)  # whatever was in flight
    passed = c.use(link_sign, moved.end, link_end.PASSED, heard, now, bound)
    c.show(c.negation(passed.end.alive), "UxAS does not count the instance as heard")
    c.show(c.implies(end.alive, passed.act == link_end.SAY_SILENT), "and says so")
    after = c.use(link_sign, passed.end, link_end.PASSED, heard, later, bound)
    quiet = c.all_of(c.negation(after.end.alive), after.act == link_end.NOTHING)
    c.show(quiet, "and so it stays, said once")
    for text, instant in (("at once", now), ("later", later)):
        flown = c.use(cycle_flown, cycle, free, heard, instant, bound, least)
        stands = c.use(gate_wished, gate, flown.act)
        opens = c.all_of(stands.offered, c.negation(gate.offered))
        c.show(c.negation(opens), f"{text}: no offer is opened")
        steers = c.define(instance.steers, cycle)
        goes_on = c.define(authority.may_command, stands, 1)
        c.show(c.implies(steers, goes_on), f"{text}: ICAROUS goes on commanding")
