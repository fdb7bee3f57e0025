"""A deal of the tasks counts as possible exactly as long as no vehicle is free later than it has to
leave."""

from cratous.core.assignment_steps import keeps_step
from cratous.proofs.claim import Claim
from cratous.spec import assignment


def claim(c: Claim) -> None:
    ok, free, latest = c.boolean("ok"), c.integer("free"), c.integer("latest")
    kept = c.use(keeps_step, ok, free, latest)
    c.show(c.same(kept, c.define(assignment.keeps_step, ok, free, latest)))
