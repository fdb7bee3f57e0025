"""A constraint row holds for the kernel exactly when at no instant at which the task runs it runs
outside what the row allows, for all times and bounds in milliseconds."""

from cratous.core.timing import row_holds
from cratous.proofs.claim import Claim
from cratous.spec import schedule


def claim(c: Claim) -> None:
    kind, start, end, ref, lo, hi, t = (
        c.integer(name) for name in ["kind", "start", "end", "ref", "lo", "hi", "t"]
    )
    c.premise(start <= end)
    holds = c.use(row_holds, kind, start, end, ref, lo, hi)
    at_t = c.define(schedule.row_holds, t, kind, start, end, ref, lo, hi)
    c.show(c.implies(holds, at_t), "if it holds, it holds at every instant")
    # where it does not, the task's own start or end is an instant that shows it
    at_start = c.define(schedule.row_holds, start, kind, start, end, ref, lo, hi)
    at_end = c.define(schedule.row_holds, end, kind, start, end, ref, lo, hi)
    c.show(c.implies(c.all_of(at_start, at_end), holds), "if not, start or end shows it")
