"""Of a since, samples come of age in their order and stay so; what is remembered of them is the latest; and a
later psi never makes the verdict less, a later phi that is not true never greater."""

from cratous.core.requirements.since import (
    Broken,
    Found,
    is_due,
    since_broken,
    since_decided,
    since_found,
)
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    at, later, low, high = (c.integer(name) for name in ("at", "later", "low", "high"))
    older = c.integer("older")
    found = Found(c.integer("latest_true"), c.integer("candidate"))
    broken = Broken(c.integer("tainted"), c.integer("broken"))
    for verdict in (phi, psi):
        c.premise(verdict >= 0)
        c.premise(verdict <= 2)
    c.premise(at <= later)
    c.premise(older <= time)
    c.premise(found.true < time)
    c.premise(found.candidate < time)
    c.premise(broken.broken < time)
    c.premise(broken.tainted < time)
    due = c.use(is_due, time, at, low)
    c.show(c.same(due, time + low <= at), "of age from the lower bound on")
    c.show(c.implies(due, c.use(is_due, time, later, low)), "it stays of age")
    c.show(c.implies(due, c.use(is_due, older, at, low)), "an older one is of age before")
    now = c.use(since_found, found, time, psi)
    c.show(c.same(now.true, c.when(psi == 2, time, found.true)), "the latest true")
    c.show(c.same(now.candidate, c.when(psi != 0, time, found.candidate)), "the latest not false")
    then = c.use(since_broken, broken, time, phi)
    c.show(c.same(then.tainted, c.when(phi != 2, time, broken.tainted)), "the latest not true")
    c.show(c.same(then.broken, c.when(phi == 0, time, broken.broken)), "the latest false")
    before = c.use(since_decided, found, broken, at, high)
    c.show(c.use(since_decided, now, broken, at, high) >= before, "psi never makes it less")
    c.show(c.use(since_decided, found, then, at, high) <= before, "phi never makes it greater")
