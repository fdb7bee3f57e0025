"""A mission counts as completed exactly when there is an instant, not before its beginning and not after
its limit, at which it ends complete."""

from cratous.core.executive.steps import completes
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    outcome, end, limit, t = (c.integer(name) for name in ("outcome", "end", "limit", "t"))
    holds = c.use(completes, outcome, end, limit)
    at_t = c.define(executive.completes_at, t, outcome, end, limit)
    c.show(c.implies(at_t, holds), "any such instant will do")
    c.show(
        c.implies(holds, c.define(executive.completes_at, end, outcome, end, limit)),
        "its end is such an instant",
    )
    c.show(c.negation(c.define(executive.completes_at, 5, executive.COMPLETE, 5, 4)), "too late")
    c.show(c.negation(c.define(executive.completes_at, 5, executive.LIMIT, 5, 9)), "not complete")
    c.show(c.define(executive.completes_at, 5, executive.COMPLETE, 5, 5), "complete at the limit")
