"""A state counts as lasting exactly when it held at every instant of the time that is asked for."""

from cratous.core.authority.timeliness import lasted
from cratous.proofs.claim import Claim
from cratous.spec.authority import timeliness


def claim(c: Claim) -> None:
    since, now, least, t = (c.integer(name) for name in ("since", "now", "least", "t"))
    c.premise(least >= 0)
    c.premise(since <= now)
    said = c.use(lasted, since, now, least)
    at_any = c.define(timeliness.lasted, t, since, now, least)
    c.show(c.implies(said, at_any), "it lasted at every instant")
    witness = c.define(timeliness.lasted, now - least, since, now, least)
    c.show(c.implies(c.negation(said), c.negation(witness)), "else not at the first of them")
