"""What psi alone decides of an until, taking phi as true at the same sample, holds whatever phi turns out to be
there."""

from cratous.core.requirements.until import Times, until_decided
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    at, low, high = c.integer("at"), c.integer("low"), c.integer("high")
    times = Times(c.integer("tainted"), c.integer("candidate"))
    ahead = c.use(until_decided, times, time, 2, psi, at, low, high)
    known = c.use(until_decided, times, time, phi, psi, at, low, high)
    c.show(c.implies(ahead != 3, c.same(ahead, known)), "phi changes nothing")
