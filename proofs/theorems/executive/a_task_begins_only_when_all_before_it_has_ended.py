"""A row `after the end` lets a task begin exactly when every task that it names has ended, each at least
the row's distance before, for every number of tasks."""

from typing import Any

from cratous.core.executive.steps import all_ended_before, ended_before, may_begin
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import verdict_is_defined
from cratous.spec import executive


def claim(c: Claim) -> None:
    known, end = c.boolean("known"), c.integer("end")
    at, lo, life, early = c.integer("at"), c.integer("lo"), c.integer("life"), c.boolean("early")

    def step(ok: Any, has_ended: Any, when: Any, instant: Any, distance: Any) -> Any:
        return executive.preceded_by(ok, has_ended, when, instant, distance)

    verdict_is_defined(c, all_ended_before, (known, end), (at, lo), step, start=True)
    before, is_life = c.boolean("before"), c.all_of(life >= 0, life <= executive.FAILED)
    c.premise(is_life)
    rows_open = c.use(ended_before, before, known, end, at, lo)
    wanted = c.define(executive.preceded_by, before, known, end, at, lo)
    c.show(c.same(rows_open, wanted), "one task more")
    begins = c.use(may_begin, life, rows_open, early)
    c.show(c.implies(begins, c.all_of(before, known, at >= end + lo)), "none begins without it")
