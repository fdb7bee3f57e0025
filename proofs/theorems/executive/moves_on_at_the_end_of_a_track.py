"""At the end of its track a vehicle begins its task, waits, goes on to the next item or stays, as its
phase and what it may do demand and not otherwise; one that UxAS does not fly does nothing, so that no
task begins or ends while ICAROUS has its vehicle."""

from cratous.core.executive.steps import end_passed
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    phase, suspended = c.integer("phase"), c.boolean("suspended")
    opens, more = c.boolean("opens"), c.boolean("more")
    c.premise(c.all_of(phase >= executive.TRANSIT, phase <= executive.DONE))
    moved = c.use(end_passed, phase, suspended, opens, more)
    right = c.define(executive.is_after_passing, phase, suspended, opens, more, moved)
    c.show(right, "as it must be")
    other = executive.Moved(c.integer("other_phase"), c.integer("other_act"))
    another = c.define(executive.is_after_passing, phase, suspended, opens, more, other)
    c.show(c.implies(another, c.same(other, tuple(moved))), "and it can be no other")
    begins = moved.act == executive.START
    c.show(c.implies(begins, c.all_of(opens, c.negation(suspended))), "no task begins otherwise")
    ends = moved.act == executive.GO_ON
    flown = c.all_of(phase == executive.TASK, c.negation(suspended))
    c.show(c.same(ends, flown), "a task ends when its path has been flown")
    c.show(
        c.implies(c.all_of(suspended), c.all_of(moved.phase == phase, moved.act == 0)),
        "nothing happens to one that UxAS does not fly",
    )
