"""A start counts as too early exactly when the planned time comes at no instant within the margin
after it."""

from cratous.core.authority.timeliness import too_early
from cratous.proofs.claim import Claim
from cratous.spec.authority import timeliness


def claim(c: Claim) -> None:
    at, planned, margin, t = (c.integer(name) for name in ("at", "planned", "margin", "t"))
    c.premise(margin >= 0)
    said = c.use(too_early, at, planned, margin)
    at_any = c.define(timeliness.too_early, t, at, planned, margin)
    c.show(c.implies(said, at_any), "the plan is ahead at every instant")
    witness = c.define(timeliness.too_early, at + margin, at, planned, margin)
    c.show(c.implies(c.negation(said), c.negation(witness)), "else it comes within the margin")
    c.show(
        c.define(timeliness.too_early, at - 1, at, planned, margin), "no word on what was before"
    )
    after = c.define(timeliness.too_early, at + margin + 1, at, planned, margin)
    c.show(after, "no word on what comes after the margin")
