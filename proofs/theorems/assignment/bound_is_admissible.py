"""If leaving the task after `after` is too late for what follows it, then leaving for the task after
the kernel's latest departure is too late as well. One step from a task to the one before it; a table of
such departures is made of these steps from the last task on."""

from cratous.core.assignment.steps import latest_departure
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    names = ["leave", "start", "due", "after", "release", "duration", "travel"]
    leave, start, due, after, release, duration, travel = (c.integer(name) for name in names)
    in_time = c.boolean("the_rest_is_in_time")
    for time in (leave, release, duration, travel, start):
        c.premise(c.all_of(time >= 0, time <= 2**59))
    for time in (due, after):
        c.premise(c.all_of(time >= -(2**59), time <= 2**59))
    # what is flown: there after the departure, released, ended by its latest end
    c.premise(start >= leave + travel)
    c.premise(start >= release)
    c.premise(start + duration <= due)
    # the table is right for what follows
    c.premise(c.implies(start + duration > after, c.negation(in_time)))
    latest = c.use(latest_departure, due, after, release, duration, travel)
    c.show(c.implies(leave > latest, c.negation(in_time)))
