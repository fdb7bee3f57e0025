"""A deal of the tasks counts as possible exactly as long as each vehicle has an instant at which it may
leave: it is free, and it is not after its latest departure."""

from cratous.core.assignment.steps import keeps_step
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    ok, free, latest = c.boolean("ok"), c.integer("free"), c.integer("latest")
    leave = c.integer("leave")
    kept = c.use(keeps_step, ok, free, latest)
    at_once = c.define(assignment.all_may_leave_at, free, ok, free, latest)
    c.show(c.implies(kept, at_once), "they may leave when they are free")
    at_any = c.define(assignment.all_may_leave_at, leave, ok, free, latest)
    c.show(c.implies(at_any, kept), "no instant is missed")
