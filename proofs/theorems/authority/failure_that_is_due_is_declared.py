"""If none has been declared, a heartbeat declares a failure exactly if one is due by then, and it declares that one."""

from cratous.core.authority.failure import Failure, failure_step
from cratous.core.authority.failure_due import failure_due
from cratous.proofs.claim import Claim
from cratous.proofs.methods.command import any_failure
from cratous.spec.authority import failure


def claim(c: Claim) -> None:
    before, seen = any_failure(c)
    now = seen[3]
    c.premise(before.kind == failure.NONE)
    after = c.use(failure_step, before, *seen)
    due = c.use(failure_due, *seen)
    is_due = c.all_of(due.kind != failure.NONE, due.by_ms <= now)
    c.show(c.implies(is_due, c.same(after, Failure(due.kind, now))), "the one that is due")
    c.show(c.implies(c.negation(is_due), c.same(after, before)), "else none")
