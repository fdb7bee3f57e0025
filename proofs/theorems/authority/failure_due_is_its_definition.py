"""Which failure is due first, if what is seen stays, and when, is what its definition says; it is not before now."""

from cratous.core.authority.failure_due import failure_due
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_failure
from cratous.spec.authority import failure
from cratous.spec.authority import failure_due as meant


def claim(c: Claim) -> None:
    _, seen = any_failure(c)
    now = seen[3]
    due = c.use(failure_due, *seen)
    t = c.integer("t")
    c.show(c.define(meant.is_due, t, *seen, due), "at every instant")
    there = due.kind != failure.NONE
    c.show(c.implies(there, due.by_ms >= now), "it is not before now")
    c.show(c.define(failure.is_kind, due.kind), "it is none, or one of the four")
