"""A wait holds for the checker exactly when it is none or so many laps that can be flown can take that long; and the
fewest laps that are long enough are as good as any other number."""

from cratous.core.assignment.steps import wait_holds
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    wait, laps, more = c.integer("wait"), c.integer("laps"), c.integer("more")
    lap, lap_max = c.integer("lap"), c.integer("lap_max")
    for time in (wait, lap, lap_max):
        c.premise(c.all_of(time >= 0, time <= 2**40))
    for number in (laps, more):
        c.premise(c.all_of(number >= 0, number <= 2**20))
    holds = c.use(wait_holds, wait, laps, lap, lap_max)
    each, longer = c.integer("each"), c.integer("longer")
    flown = c.define(assignment.is_flown_in_laps, wait, laps, lap, lap_max, each, longer)
    c.show(c.implies(flown, holds), "no laps are missed")
    # the wait shared out among the laps, named by the equation that defines it
    share, rest = c.integer("share"), c.integer("rest")
    shared = c.all_of(share * laps + rest == wait, rest >= 0, rest < laps)
    c.premise(c.any_of(laps == 0, shared))
    found = c.define(assignment.is_flown_in_laps, wait, laps, lap, lap_max, share, rest)
    c.show(c.implies(holds, found), "laps of almost one length fill the wait")
    enough = c.all_of(laps <= more, laps >= 1, wait <= laps * lap_max)
    c.step(c.implies(enough, laps * lap <= more * lap), "more laps take longer")
    other = c.use(wait_holds, wait, more, lap, lap_max)
    c.show(c.implies(c.all_of(enough, other), holds), "the fewest are as good")
