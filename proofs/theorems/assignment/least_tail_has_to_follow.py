"""The time that the search counts after a task's end has to pass in every completion: what follows it by
order and timing starts no sooner than the row says, takes its time, and has its own to follow it."""

from cratous.core.assignment.lower_bounds import tail_step
from cratous.core.schedule.rows import row_holds
from cratous.proofs.claim import Claim
from cratous.spec.assignment import bounds as assignment_bounds


def claim(c: Claim) -> None:
    names = [
        "last",
        "end",
        "tail",
        "lag",
        "least",
        "after",
        "start2",
        "end2",
        "duration2",
        "ref",
        "hi",
    ]
    last, end, tail, lag, least, after, start2, end2, duration2, ref, hi = map(c.integer, names)
    for time in (last, end, tail, least, after, start2, end2, duration2, ref, hi):
        c.premise(c.all_of(time >= 0, time <= 2**58))
    c.premise(c.all_of(lag >= -(2**58), lag <= 2**58))
    result = c.use(tail_step, tail, lag, least, after)
    may = c.define(assignment_bounds.may_be_last, last, end, tail, lag, least, after)
    c.show(c.same(may, last >= end + result), "it is the least time that there may be")
    # the row of the task that follows holds, and its reference ends no sooner than this task
    c.premise(c.all_of(c.use(row_holds, 1, start2, end2, ref, lag, hi), ref >= end))
    c.premise(c.all_of(end2 == start2 + duration2, duration2 >= least))
    c.premise(c.all_of(last >= end + tail, last >= end2 + after))
    c.show(last >= end + result, "the latest end of all is no sooner")
