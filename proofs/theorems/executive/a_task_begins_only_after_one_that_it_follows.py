"""A row `after the start` lets a task begin exactly when some task that it names has begun at least the
row's distance before, for every number of tasks; once it does it goes on doing so."""

from typing import Any

from cratous.core.executive.steps import begun_before, some_begun_before
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import verdict_is_defined
from cratous.spec import executive


def claim(c: Claim) -> None:
    known, start = c.boolean("known"), c.integer("start")
    at, lo, later = c.integer("at"), c.integer("lo"), c.integer("later")

    def step(ok: Any, has_begun: Any, when: Any, instant: Any, distance: Any) -> Any:
        return executive.followed(ok, has_begun, when, instant, distance)

    verdict_is_defined(c, some_begun_before, (known, start), (at, lo), step, start=False)
    before = c.boolean("before")
    now = c.use(begun_before, before, known, start, at, lo)
    c.show(c.same(now, c.define(executive.followed, before, known, start, at, lo)), "one more")
    then = c.use(begun_before, before, known, start, later, lo)
    c.show(c.implies(c.all_of(now, later >= at), then), "it stays open")
