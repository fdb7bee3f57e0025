"""A state covers another for the kernel exactly when at no instant one of its times has not come and the
other's has, for every number of times; the instant that decides it is the other's time."""

from typing import Any

from cratous.core.assignment.steps import covers, covers_step
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def model_step(ok: Any, mine: Any, other: Any) -> Any:
    return assignment.is_covered_step(other, ok, mine, other)


def claim(c: Claim) -> None:
    ok, mine, other, t = c.boolean("ok"), c.integer("mine"), c.integer("other"), c.integer("t")
    covered = c.use(covers_step, ok, mine, other)
    at_any = c.define(assignment.is_covered_step, t, ok, mine, other)
    c.show(c.implies(covered, at_any), "at every instant")
    at_other = c.define(assignment.is_covered_step, other, ok, mine, other)
    c.show(c.implies(at_other, covered), "the other's time decides")
    c.fold(
        covers,
        acc=c.boolean("all_covered"),
        model=c.boolean("covered"),
        item=(mine, other),
        context=(),
        model_start=True,
        model_step=model_step,
        relation=c.same,
    )
