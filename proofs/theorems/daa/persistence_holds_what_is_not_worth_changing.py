"""A resolution, or the preferred direction, that is shown is held exactly while its direction is new, the
change would be small, or what takes its place keeps a smaller distance; so advice never changes to a
way that keeps less, and neither a longer persistence nor a greater least change holds less."""

from cratous.core.daa.persistence import direction_kept, resolution_kept
from cratous.proofs.claim import Claim
from cratous.spec.daa import persistence as daa_persistence


def claim(c: Claim) -> None:
    preferred = c.boolean("preferred")
    before, now = c.integer("before"), c.integer("now")
    age, persistence, beyond, least, more, longer = c.reals(
        "age persistence beyond least more longer"
    )
    up, down = c.reals("up down")
    c.premise(c.all_of(before >= -1, now >= -1, longer >= persistence, more >= least))
    kept = c.use(resolution_kept, preferred, before, now, age, persistence, beyond, least)
    meant = c.define(daa_persistence.kept, preferred, before, now, age, persistence, beyond, least)
    c.show(c.same(kept, meant), "resolutions")
    wider = c.use(resolution_kept, preferred, before, now, age, longer, beyond, more)
    c.show(c.implies(kept, wider), "a longer persistence holds no less")
    costs = c.all_of(preferred, now > before)
    c.show(c.implies(costs, kept), "the preferred one is not given up for a smaller distance")
    stays = c.use(direction_kept, age, persistence, up, down, least, before, now)
    also = c.define(daa_persistence.direction_kept, age, persistence, up, down, least, before, now)
    c.show(c.same(stays, also), "directions")
    c.show(c.implies(now > before, stays), "no direction is changed for a smaller distance")
    later = c.use(direction_kept, age, longer, up, down, more, before, now)
    c.show(c.implies(stays, later), "nor does it change sooner")
