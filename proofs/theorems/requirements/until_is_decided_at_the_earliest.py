"""A sample's until waits only where the trace can go on in two ways, each a single sample more, that decide
it differently."""

from cratous.core.requirements.until import Times, until_decided, until_times
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    at, low, high = c.integer("at"), c.integer("low"), c.integer("high")
    times = Times(c.integer("tainted"), c.integer("candidate"))
    small = 2**59
    for value in (time, at, low, high, *times):
        c.premise(value >= -small)
        c.premise(value <= small)
    c.premise(low >= 0)
    c.premise(low <= high)
    c.premise(at <= time)
    c.premise(times.tainted < time)
    c.premise(times.candidate < time)
    # what waited before this sample: psi was not false within the bounds only where phi was known
    c.premise(c.negation(c.all_of(times.tainted >= at, times.candidate >= at + low)))
    waits = c.use(until_decided, times, time, phi, psi, at, low, high) == 3
    after = c.use(until_times, times, time, phi, psi)
    soon = c.when(time + 1 >= at + low, time + 1, at + low)
    fulfilled = c.use(until_decided, after, soon, 2, 2, at, low, high)
    given_up = c.use(until_decided, after, soon, 0, 0, at, low, high)
    c.show(c.implies(waits, c.all_of(fulfilled != 3, given_up != 3)), "both decide it")
    c.show(c.implies(waits, fulfilled > given_up), "and differently")
