"""A task starts for the kernel at the earliest instant at which its vehicle can have got there, no
later task would start before, and order and timing allow it."""

from cratous.core.assignment.steps import earliest_start
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    t, free, travel, floor, ref = (c.integer(x) for x in ["t", "free", "travel", "floor", "ref"])
    for time in (free, travel, floor, ref):
        c.premise(time >= 0)
    c.premise(free + travel <= 2**61)
    start = c.use(earliest_start, free, travel, floor, ref)
    may = c.define(assignment.may_start, t, free, travel, floor, ref)
    c.show(c.same(may, t >= start))
