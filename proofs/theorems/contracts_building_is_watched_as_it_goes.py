"""Watching two parts changes nothing: the builder goes on exactly as it does unwatched, and what is seen of
its answers is what it answered."""

from cratous.core.contracts.building import (
    Building,
    WatchedParts,
    building_step,
    part_after,
    watched_parts_step,
)
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    event, number, one, other = (c.integer(n) for n in ("event", "number", "one", "other"))
    first, second = c.integer("first"), c.integer("second")
    building = Building(c.integer("stage"), c.integer("parts"), c.integer("at"))
    planned, failed = c.boolean("planned"), c.boolean("failed")
    c.opaque(building_step)
    watched = WatchedParts(*building, first, second, planned, failed, c.boolean("held"))
    w = c.use(watched_parts_step, watched, event, number, one, other)
    went_on, act, part, done = c.use(building_step, building, event, number)
    c.show(c.same(Building(w.stage, w.parts, w.at), went_on), "the builder")
    c.show(c.same(w.planned, c.any_of(planned, act == 2)), "its plan")
    c.show(c.same(w.failed, c.any_of(failed, act == 3)), "its failure")
    for seen, before, mine in ((w.first, first, one), (w.second, second, other)):
        asked, answered = c.all_of(act == 1, part == mine), c.all_of(done, number == mine)
        c.show(seen == c.use(part_after, before, asked, answered), "a part")
