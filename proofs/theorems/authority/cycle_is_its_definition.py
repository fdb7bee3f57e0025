"""At each heartbeat an ICAROUS instance takes notice of its gate, then takes over, offers control or
withdraws its offer exactly when its definition says so, and what it remembers is as defined."""

from cratous.core.authority.cycle import Cycle, cycle_begun, cycle_flown, cycle_watched, patience
from cratous.proofs.claim import Claim
from cratous.spec.authority import cycle as authority_cycle


def cycle_of(c: Claim, name: str) -> Cycle:
    return Cycle(
        c.integer(f"{name}mode"),
        c.integer(f"{name}relapses"),
        c.boolean(f"{name}handed"),
        c.integer(f"{name}handed_ms"),
        c.boolean(f"{name}free"),
        c.integer(f"{name}free_ms"),
    )


def claim(c: Claim) -> None:
    before, other, act = cycle_of(c, ""), cycle_of(c, "other_"), c.integer("other_act")
    now, soon, heard, bound, least = (
        c.integer(name) for name in ("now", "soon", "heard", "bound", "least")
    )
    commands, foreseen, free = (c.boolean(name) for name in ("commands", "foreseen", "way_free"))
    c.premise(c.all_of(soon >= 0, bound >= 0, least >= 0, least <= 2**56))

    begun = c.use(cycle_begun, before, commands, now)
    c.show(c.define(authority_cycle.is_after_notice, before, commands, now, begun), "notice")
    another = c.define(authority_cycle.is_after_notice, before, commands, now, other)
    c.show(c.implies(another, c.same(other, begun)), "and it can be no other")
    c.show(c.same(c.define(authority_cycle.steers, begun), commands), "it steers iff it may")

    watched = c.use(cycle_watched, before, foreseen, now, soon)
    right = c.define(
        authority_cycle.is_after_watch, before, foreseen, now, soon, watched.cycle, watched.act
    )
    c.show(right, "watch")
    another = c.define(authority_cycle.is_after_watch, before, foreseen, now, soon, other, act)
    only = c.all_of(c.same(other, watched.cycle), act == watched.act)
    c.show(c.implies(another, only), "and it can be no other")

    asked = c.use(patience, before.relapses, least)
    flown = c.use(cycle_flown, before, free, heard, now, bound, least)
    rest = (before, free, heard, now, bound, asked)
    right = c.define(authority_cycle.is_after_flight, *rest, flown.cycle, flown.act)
    c.show(right, "flight")
    another = c.define(authority_cycle.is_after_flight, *rest, other, act)
    only = c.all_of(c.same(other, flown.cycle), act == flown.act)
    c.show(c.implies(another, only), "and it can be no other")
    mode = c.define(authority_cycle.is_mode, before.mode)
    for after in (begun, watched.cycle, flown.cycle):
        stays = c.define(authority_cycle.is_mode, after.mode)
        c.show(c.implies(mode, stays), "it is in one of three modes")
