"""Watching two parts changes nothing: the builder goes on exactly as it does unwatched, and what is seen of
its answers is what it answered. All is held to be in order exactly as long as its parts are."""

from cratous.core.contracts import building as kernels
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    event, number, one, other = (c.integer(n) for n in ("event", "number", "one", "other"))
    first, second = c.integer("first"), c.integer("second")
    building = kernels.Building(c.integer("stage"), c.integer("parts"), c.integer("at"))
    planned, failed = c.boolean("planned"), c.boolean("failed")
    c.opaque(kernels.building_step, kernels.part_seen)
    held = c.boolean("held")
    watched = kernels.WatchedParts(*building, first, second, planned, failed, held)
    w = c.use(kernels.watched_parts_step, watched, event, number, one, other)
    went_on, act, part, done = c.use(kernels.building_step, building, event, number)
    c.show(c.same(kernels.Building(w.stage, w.parts, w.at), went_on), "the builder")
    c.show(c.same(w.planned, c.any_of(planned, act == 2)), "its plan")
    c.show(c.same(w.failed, c.any_of(failed, act == 3)), "its failure")
    for seen, before, mine in ((w.first, first, one), (w.second, second, other)):
        moved = c.use(kernels.part_seen, before, mine, act, part, done, number)
        c.show(seen == moved, "a part")
    answers = c.any_of(act == 2, act == 3)
    due = c.all_of(w.planned, other < w.parts)  # a plan is of the parts that the assignment has
    again = c.all_of(c.any_of(planned, failed), answers)
    orderly = c.use(kernels.parts_orderly, w.first, w.second, due, again)
    c.show(c.same(w.held, c.all_of(held, orderly)), "in order")
