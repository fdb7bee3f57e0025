"""The bound of a state is no more than the cost of any completion whose latest end, last ends together and
legs are no less than what was summed up: so leaving a state out because its bound is not below the
limit loses no completion below the limit."""

from cratous.core.assignment.lower_bounds import add_least
from cratous.core.assignment.steps import soonest_end, weighted
from cratous.core.schedule.rows import later
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    names = ["last", "soonest", "head", "least", "tail", "team", "work", "legs", "cheap", "limit"]
    last, soonest, head, least, tail, team, work, legs, cheap, limit = map(c.integer, names)
    # of any completion: latest end, last ends together, legs; and of the task its start and duration
    ends = ["last_of_all", "team_of_all", "legs_of_all", "start", "duration", "legs_before", "leg"]
    last2, team2, legs2, start, duration, before, leg = map(c.integer, ends)
    per_makespan, per_team = c.integer("per_makespan"), c.integer("per_team")
    for value in (last, soonest, head, least, tail, team, work, legs, cheap):
        c.premise(c.all_of(value >= 0, value <= 2**36))
    for value in (last2, team2, legs2, start, duration, before, leg):
        c.premise(c.all_of(value >= 0, value <= 2**38))
    for weight in (per_makespan, per_team):
        c.premise(c.all_of(weight >= 0, weight <= 2**20))
    # one task that is left: it starts and lasts as it must, and `last` was right before it
    c.premise(c.all_of(last <= last2, start >= head, duration >= least))
    c.premise(c.all_of(start + duration >= soonest, last2 >= start + duration + tail))
    end = c.use(soonest_end, soonest, head, least)
    latest = c.use(later, last, end + tail)
    c.show(latest <= last2, "the latest end that was counted is no later")
    # its leg, and those before it
    c.premise(c.all_of(legs <= before, cheap <= leg, before + leg <= legs2))
    flown = c.use(add_least, legs, True, cheap)
    c.show(flown <= legs2, "nor do the legs cost more")
    c.premise(team + work <= team2)
    c.opaque(weighted)
    bounds = latest, team + work, flown
    low = c.use(weighted, *bounds, per_makespan, per_team)
    cost = c.use(weighted, last2, team2, legs2, per_makespan, per_team)
    names = ["makespan", "team", "added", "makespan2", "team2", "added2"]
    c.lemma(
        "assignment_cost_is_its_definition_and_never_falls",
        **dict(zip(names, (*bounds, last2, team2, legs2), strict=True)),
        per_makespan=per_makespan,
        per_team=per_team,
    )
    c.show(low <= cost, "the bound is no more than the cost")
    c.show(c.implies(low >= limit, cost >= limit), "what is left out costs no less than the limit")
