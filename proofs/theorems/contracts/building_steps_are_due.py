"""With an assignment the plan builder asks for its first part at once; when the part that it waits for
is built it asks for the next at once, or answers with the plan after the last; a failure, or an
assignment of nothing, is answered with an error at once; nothing else changes anything, and it is
reported."""

from cratous.core.contracts.building import Building, building_step, part_after
from cratous.proofs.claim import Claim
from cratous.spec.contracts import building


def claim(c: Claim) -> None:
    b = Building(c.integer("stage"), c.integer("count"), c.integer("at"))
    event, number = c.integer("event"), c.integer("number")
    c.premise(c.all_of(b.stage >= 0, b.stage <= 2, b.at >= 0, b.parts <= 2**60))
    step = c.use(building_step, b, event, number)
    after = step.building
    assigned = c.all_of(event == 1, b.stage == 0, number >= 1, number <= 2**60)
    first = c.all_of(after.stage == 1, after.parts == number, after.at == 0)
    asks = c.all_of(step.act == 1, step.part == after.at)
    c.show(c.implies(assigned, c.all_of(first, asks, c.negation(step.done))), "the first part")
    awaited = c.all_of(event == 2, b.stage == 1, number == b.at)
    more = c.all_of(awaited, b.at + 1 < b.parts)
    on = c.all_of(after.stage == 1, after.parts == b.parts, after.at == b.at + 1)
    c.show(c.implies(more, c.all_of(on, asks, step.done)), "the next part")
    last = c.all_of(awaited, b.at + 1 >= b.parts)
    over = c.all_of(after.stage == 2, after.parts == b.parts, after.at == b.at)
    plan = c.all_of(step.act == 2, step.part == b.at, step.done)
    c.show(c.implies(last, c.all_of(over, plan)), "the plan after the last")
    fails = c.all_of(event == 3, b.stage < 2)
    error = c.all_of(step.act == 3, c.negation(step.done))
    c.show(c.implies(fails, c.all_of(over, error, step.part == b.at)), "a failure")
    nothing = c.all_of(event == 1, b.stage == 0, c.any_of(number < 1, number > 2**60))
    empty = c.all_of(after.stage == 2, after.parts == 0, after.at == 0, step.part == 0)
    c.show(c.implies(nothing, c.all_of(empty, error)), "an assignment of nothing")
    rest = c.negation(c.any_of(assigned, awaited, fails, nothing))
    report = c.all_of(step.act == 4, step.part == number, c.negation(step.done))
    c.show(c.implies(rest, c.all_of(c.same(after, b), report)), "nothing else")
    stage, asked, built = c.integer("part_stage"), c.boolean("asked"), c.boolean("built")
    part_stage = c.use(part_after, stage, asked, built)
    one = c.negation(c.all_of(asked, built))
    what = c.when(asked, building.ASKED, c.when(built, building.BUILT, 0))
    due = c.define(building.after, stage, what)
    c.show(c.implies(one, part_stage == due), "the watcher steps as the definition says")
    c.show(c.implies(c.negation(one), part_stage == building.WRONG), "both at once is wrong")
