"""A message counts as in time exactly when at no instant since it came it was older than the bound."""

from cratous.core.authority.timeliness import in_time
from cratous.proofs.claim import Claim
from cratous.spec.authority import timeliness


def claim(c: Claim) -> None:
    last, now, bound, t = (c.integer(name) for name in ("last", "now", "bound", "t"))
    c.premise(bound >= 0)
    said = c.use(in_time, last, now, bound)
    at_any = c.define(timeliness.in_time, t, last, now, bound)
    c.show(c.implies(said, at_any), "in time at every instant")
    witness = c.define(timeliness.in_time, now, last, now, bound)
    c.show(c.implies(c.negation(said), c.negation(witness)), "else not in time now")
    came = c.define(timeliness.in_time, last, last, now, bound)
    c.show(c.same(came, last <= now), "in time when it came")
    first_late = last + bound + 1
    late = c.define(timeliness.in_time, first_late, last, now, bound)
    c.show(c.implies(first_late <= now, c.negation(late)), "late from right after the bound on")
