"""The plan builder asks for every task of the assignment once, in assignment order, each only after the
one before was built, and answers its request once: with a plan when all are built, or with an error;
for every number of tasks and every sequence of events, repeated and foreign ones included."""

from typing import Any

from cratous.core.contracts.building import WatchedParts, parts_in_order
from cratous.proofs.claim import Claim
from cratous.spec.contracts.building import Parts, in_order

MANY = 2**60


def stage_of(c: Claim, w: Any, part: Any) -> Any:
    """Where the counters say that a part is."""
    last = c.when(w.planned, 2, 1)
    begun = c.when(part < w.at, 2, c.when(part == w.at, last, 0))
    return c.when(w.parts == 0, 0, begun)


def claim(c: Claim) -> None:
    event, number = c.integer("event"), c.integer("number")
    one, other = c.integer("one"), c.integer("other")
    c.premise(c.all_of(one >= 0, one < other))
    stage, parts, at = c.whole("stage"), c.whole("parts"), c.whole("at")
    first, second = c.whole("first"), c.whole("second")
    planned, failed, held = c.boolean("planned"), c.boolean("failed"), c.boolean("held")
    w = WatchedParts(stage, parts, at, first, second, planned, failed, held)

    def related(w: Any, held: Any) -> Any:
        idle = c.implies(w.stage == 0, c.all_of(w.parts == 0, w.at == 0))
        building = c.implies(w.stage == 1, w.parts >= 1)
        counters = c.all_of(w.stage >= 0, w.stage <= 2, w.parts >= 0, w.parts <= MANY, idle)
        position = c.all_of(w.at >= 0, c.any_of(w.at < w.parts, w.parts == 0), building)
        answered = c.same(c.any_of(w.planned, w.failed), w.stage == 2)
        whole = c.implies(w.planned, c.all_of(w.parts >= 1, w.at == w.parts - 1))
        stages = c.all_of(
            c.same(w.first, stage_of(c, w, one)), c.same(w.second, stage_of(c, w, other))
        )
        seen = Parts(w.first, w.second, c.when(w.planned, 1, 0), c.when(w.failed, 1, 0))
        orderly = c.implies(other < w.parts, c.define(in_order, seen))
        one_answer = c.negation(c.all_of(w.planned, w.failed))
        return c.all_of(
            counters,
            position,
            answered,
            whole,
            stages,
            orderly,
            one_answer,
            c.same(w.held, held),
            w.held,
        )

    c.fold(
        parts_in_order,
        acc=w,
        model=c.boolean("all_held"),
        item=(event, number),
        context=(one, other),
        model_start=True,
        model_step=lambda held, *_: held,
        relation=related,
    )
