"""A start counts as too early exactly when the planned time comes at no instant within the margin
after it."""

from cratous.core.authority.timeliness import too_early
from cratous.proofs.claim import Claim
from cratous.proofs.methods.timely import holds_at_every_instant
from cratous.spec.authority import timeliness


def claim(c: Claim) -> None:
    at, planned, margin = (c.integer(name) for name in ("at", "planned", "margin"))
    c.premise(margin >= 0)
    holds_at_every_instant(
        c,
        too_early,
        timeliness.too_early,
        (at, planned, margin),
        at + margin,
        ("the plan is ahead at every instant", "else it comes within the margin"),
    )
    c.show(
        c.define(timeliness.too_early, at - 1, at, planned, margin), "no word on what was before"
    )
    after = c.define(timeliness.too_early, at + margin + 1, at, planned, margin)
    c.show(after, "no word on what comes after the margin")
