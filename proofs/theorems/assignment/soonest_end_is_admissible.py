"""The earliest end that the kernel gives a task is the earliest that there may be: no schedule in which
it starts and lasts as it must ends it sooner, and what has to follow it only adds to that."""

from cratous.core.assignment.steps import soonest_end
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    names = ["start", "duration", "soonest", "head", "least", "tail", "last"]
    start, duration, soonest, head, least, tail, last = (c.integer(name) for name in names)
    for time in (start, duration, soonest, head, least, tail, last):
        c.premise(c.all_of(time >= 0, time <= 2**58))
    end = start + duration
    earliest = c.use(soonest_end, soonest, head, least)
    may = c.define(assignment.task_may_end, end, soonest, head, least)
    c.show(c.same(may, end >= earliest), "it is the earliest end that there may be")
    c.premise(c.all_of(start >= head, duration >= least, end >= soonest))
    c.premise(last >= end + tail)
    c.show(last >= earliest + tail, "the latest end of all is no sooner than what follows allows")
