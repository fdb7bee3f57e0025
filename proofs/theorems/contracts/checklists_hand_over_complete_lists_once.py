"""The collector of a request asks for routes as soon as all options are there and hands the matrix over
as soon as all routes are there too; never before, never twice, and never anything incomplete."""

from cratous.core.contracts.checklists import collector_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import checklists


def claim(c: Claim) -> None:
    stage = c.integer("stage")
    options, routes = c.boolean("all_options"), c.boolean("all_routes")
    step = c.use(collector_step, stage, options, routes)
    c.show(step.stage == c.define(checklists.collected, stage, options, routes), "the stage")
    asks, hands = step.act == 1, step.act == 2
    c.show(c.same(asks, c.all_of(stage == 1, options)), "routes are asked for in time")
    c.show(c.same(hands, c.all_of(stage == 2, options, routes)), "the matrix is complete")
    c.show(c.any_of(asks, hands, step.act == 0), "else nothing is done")
    c.show(c.same(c.any_of(asks, hands), step.stage > stage), "each is done once")
    c.show(step.stage >= stage, "no stage comes back")
    again = c.use(collector_step, step.stage, options, routes)
    both = c.all_of(stage == 1, options, routes)
    c.show(c.implies(both, again.act == 2), "what is complete from the start is handed over")
