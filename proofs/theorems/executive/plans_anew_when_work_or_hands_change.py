"""A change asks for another plan by itself exactly if it takes work from a vehicle, withdraws a task that
has not ended, brings work or hands, or ends a zone while tasks are left undone that it may have forbidden."""

from cratous.core.executive.steps import change_counts
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    kind, left, ended = c.integer("kind"), c.integer("left"), c.boolean("ended")
    counts = c.use(change_counts, kind, left, ended)
    c.show(c.same(counts, c.define(executive.change_counts, kind, left, ended)), "its definition")
    idle = c.all_of(kind == executive.LOST, left <= 0)
    c.show(c.implies(idle, c.negation(counts)), "nobody misses a vehicle without work")
    whole = c.all_of(kind == executive.ZONE_ENDED, left <= 0)
    c.show(
        c.implies(whole, c.negation(counts)), "nor the end of a zone, where nothing is left undone"
    )
    undone = c.all_of(kind == executive.ZONE_ENDED, left > 0)
    c.show(c.implies(undone, counts), "what a zone left undone is planned for when it ends")
    done = c.all_of(kind == executive.REMOVED, ended)
    c.show(c.implies(done, c.negation(counts)), "nor a task that is done")
