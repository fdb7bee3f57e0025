"""A request is accepted exactly when every vehicle that it names is configured with a known or given
state, every task is known and initialised, its region and all its zones are known, and it names a
vehicle and a task; for every number of vehicles, tasks and zones."""

from typing import Any

from cratous.core.contracts.validity import Faults, item_fault, request_valid
from cratous.proofs.claim import Claim
from cratous.spec.contracts.validity import Found, found_step, holds, valid


def model_step(found: Any, kind: Any, known: Any, ready: Any, given: Any) -> Any:
    return found_step(found, holds(kind, known, ready, given), kind)


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    known, ready, given = c.boolean("known"), c.boolean("ready"), c.boolean("given")
    fine = c.define(holds, kind, known, ready, given)
    fault = c.use(item_fault, kind, known, ready, given)
    c.show(c.same(fault == 0, fine), "a thing has no fault exactly if it holds")
    some = c.all_of(kind >= 1, kind <= 4)
    c.show(c.same(fault == 1, c.all_of(some, c.negation(known))), "1 means unknown")
    c.show(c.same(fault == 2, c.all_of(some, known, c.negation(fine))), "2 means not ready")
    c.show(c.implies(c.negation(some), fault == 3), "3 means no such kind")
    acc = Faults(c.boolean("fault"), c.boolean("vehicle"), c.boolean("task"))
    model = Found(c.boolean("all_hold"), c.boolean("a_vehicle"), c.boolean("a_task"))
    c.fold(
        request_valid,
        acc=acc,
        model=model,
        item=(kind, known, ready, given),
        context=(),
        model_start=Found(True, False, False),
        model_step=model_step,
        model_finish=valid,
        relation=lambda a, m: c.all_of(
            c.same(c.negation(a.fault), m.all_hold),
            c.same(a.vehicle, m.a_vehicle),
            c.same(a.task, m.a_task),
        ),
    )
