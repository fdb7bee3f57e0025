"""If no stop is a shortcut then a vehicle reaches its first task, and the next one after a task that it
reached so, no sooner after it was free than the shortest way there takes. The first step and one step on;
a chain is made of these."""

from cratous.core.assignment.lower_bounds import no_shortcut
from cratous.core.assignment.steps import Chain, chain_step
from cratous.proofs.claim import Claim
from cratous.spec.assignment import bounds as assignment_bounds


def claim(c: Claim) -> None:
    names = ["began", "direct", "first", "stay", "second", "start", "end", "travel", "onward"]
    began, direct, first, stay, second, start, end, travel, onward = map(c.integer, names)
    start2, end2, stay2 = c.integer("start2"), c.integer("end2"), c.integer("stay2")
    for time in (
        began,
        direct,
        first,
        stay,
        second,
        start,
        end,
        travel,
        onward,
        start2,
        end2,
        stay2,
    ):
        c.premise(c.all_of(time >= 0, time <= 2**58))
    holds = c.use(no_shortcut, direct, first, stay, second)
    wanted = c.define(assignment_bounds.stop_is_no_shortcut, direct, first, stay, second)
    c.show(c.same(holds, wanted))
    # the first stop from where the chain began is no sooner than its way; asked with no stop on it
    single = c.use(no_shortcut, first, travel, 0, 0)
    one = c.use(chain_step, Chain(True, began), travel, start, end, stay)
    c.show(c.implies(c.all_of(single, one.ok), start >= began + first), "the first task of a chain")
    # a task that is reached no sooner than `first` says, and the next one after it
    c.premise(c.all_of(start >= began + first, end == start + stay))
    onwards = c.use(no_shortcut, second, onward, 0, 0)
    two = c.use(chain_step, Chain(True, end), onward, start2, end2, stay2)
    c.premise(c.all_of(holds, onwards, two.ok))
    c.show(start2 >= began + direct, "every further task")
