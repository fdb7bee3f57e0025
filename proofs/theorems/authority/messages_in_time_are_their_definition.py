"""A message counts as in time exactly when at no instant since it came it was older than the bound."""

from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.proofs.methods.timely import holds_at_every_instant
from cratous.spec.authority import timeliness


def claim(c: Claim) -> None:
    last, now, bound = (c.integer(name) for name in ("last", "now", "bound"))
    c.premise(bound >= 0)
    texts = ("in time at every instant", "else not in time now")
    holds_at_every_instant(c, in_time, timeliness.in_time, (last, now, bound), now, texts)
    came = c.define(timeliness.in_time, last, last, now, bound)
    c.show(c.same(came, last <= now), "in time when it came")
    first_late = last + bound + 1
    late = c.define(timeliness.in_time, first_late, last, now, bound)
    c.show(c.implies(first_late <= now, c.negation(late)), "late from right after the bound on")
