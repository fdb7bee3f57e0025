"""A vehicle's chain holds for the checker exactly when there are instants at which it can leave for each
task, not before it is free, and be there by its start, for every number of tasks."""

from typing import Any

from cratous.core.assignment.steps import Chain, chain_holds
from cratous.proofs.claim import Claim
from cratous.spec.assignment.search import Flown, chain_result, chain_step, leg_is_flown


def model_step(chain: Any, travel: Any, start: Any, end: Any, duration: Any) -> Any:
    # the latest instant to leave is the witness: if that one is too early, all are
    return chain_step(chain, start - travel, travel, start, end, duration)


def claim(c: Claim) -> None:
    names = ["travel", "start", "end", "duration"]
    travel, start, end, duration = (c.integer(name) for name in names)
    leave, free = c.integer("leave"), c.whole("free_before")
    for time in (travel, start, duration, end):
        c.premise(c.all_of(time >= 0, time <= 2**59))
    some = c.define(leg_is_flown, leave, free, travel, start, end, duration)
    last = c.define(leg_is_flown, start - travel, free, travel, start, end, duration)
    # who is free at 0 and leaves at 3 is not there by 4
    c.show(c.negation(c.define(leg_is_flown, 3, 0, 2, 4, 6, 2)), "an example: too late")
    c.show(c.implies(some, last), "if any departure will do, the latest will")
    c.fold(
        chain_holds,
        acc=Chain(c.boolean("ok"), c.whole("free")),
        model=Flown(c.boolean("flown"), c.whole("model_free")),
        item=(travel, start, end, duration),
        context=(),
        model_start=Flown(True, 0),
        model_step=model_step,
        model_finish=chain_result,
        relation=lambda chain, flown: c.all_of(
            c.same(chain.ok, flown.ok),
            c.same(chain.free, flown.free),
            chain.free >= 0,
            chain.free <= 2**59,
        ),
    )
