"""Where a sample's until waits, that of every later sample waits too: the oldest one that waits is decided
first."""

from cratous.core.requirements.until import Times, until_decided
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    low, high = c.integer("low"), c.integer("high")
    older, younger = c.integer("older"), c.integer("younger")
    times = Times(c.integer("tainted"), c.integer("candidate"))
    c.premise(low >= 0)
    c.premise(low <= high)
    c.premise(older <= younger)
    c.premise(younger <= time)
    first = c.use(until_decided, times, time, phi, psi, older, low, high)
    second = c.use(until_decided, times, time, phi, psi, younger, low, high)
    c.show(c.implies(first == 3, second == 3), "the younger waits with the older")
