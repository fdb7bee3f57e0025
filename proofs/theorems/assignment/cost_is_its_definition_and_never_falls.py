"""The cost is the weighted sum that is meant, and it does not fall when latest end, sum of ends or what
legs cost grow: so what a state has cost is a bound for all that comes of it."""

from cratous.core.assignment.steps import weighted
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    makespan, team, added = (c.integer(x) for x in ["makespan", "team", "added"])
    makespan2, team2, added2 = (c.integer(x) for x in ["makespan2", "team2", "added2"])
    per_makespan, per_team = c.integer("per_makespan"), c.integer("per_team")
    for time in (makespan, team, added, makespan2, team2, added2):
        c.premise(c.all_of(time >= 0, time <= 2**40))
    for weight in (per_makespan, per_team):
        c.premise(c.all_of(weight >= 0, weight <= 2**20))
    cost = c.use(weighted, makespan, team, added, per_makespan, per_team)
    meant = c.define(assignment.weighted, makespan, team, added, per_makespan, per_team)
    c.show(c.same(cost, meant), "it is what is meant")
    for one, other in ((makespan, makespan2), (team, team2), (added, added2)):
        c.premise(one <= other)
    more = c.use(weighted, makespan2, team2, added2, per_makespan, per_team)
    c.step(makespan * per_makespan <= makespan2 * per_makespan, "latest end")
    c.step(team * per_team <= team2 * per_team, "sum of ends")
    c.show(cost <= more, "it never falls")
