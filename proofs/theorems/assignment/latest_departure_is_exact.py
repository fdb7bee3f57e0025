"""A vehicle that leaves by the kernel's latest departure can do the task in time, and what follows it
as late as that allows; one that leaves later cannot, whenever it starts."""

from cratous.core.assignment.steps import latest_departure
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    names = ["leave", "start", "due", "after", "release", "duration", "travel"]
    leave, start, due, after, release, duration, travel = (c.integer(name) for name in names)
    for time in (leave, release, duration, travel):
        c.premise(c.all_of(time >= 0, time <= 2**59))
    for time in (due, after):
        c.premise(c.all_of(time >= -(2**59), time <= 2**59))
    latest = c.use(latest_departure, due, after, release, duration, travel)
    any_start = c.define(
        assignment.leaves_in_time, leave, start, due, after, release, duration, travel
    )
    c.show(c.implies(any_start, leave <= latest), "whoever is in time left by then")
    soonest = c.when(leave + travel >= release, leave + travel, release)
    at_once = c.define(
        assignment.leaves_in_time, leave, soonest, due, after, release, duration, travel
    )
    c.show(c.implies(leave <= latest, at_once), "whoever leaves by then can be in time")
    c.show(
        c.any_of(latest == -(2**60), latest + travel >= release),
        "if none can, -2^60 says so",
    )
