"""A constraint row holds for the kernel exactly when at no instant at which the task runs it runs
outside what the row allows, for all times and bounds in milliseconds."""

from cratous.core.schedule.rows import row_holds
from cratous.proofs.claim import Claim
from cratous.spec import schedule

# what a row says, its kind, and reference and bounds that forbid and that allow the instant 5
EXAMPLES = (
    ("not before the end of another", schedule.AFTER_END, (4, 6, 0), (4, 1, 0)),
    ("not before the start of another", schedule.AFTER_START, (4, 6, 0), (4, 1, 0)),
    ("within a time of an end", schedule.WITHIN_END, (1, 0, 0), (1, 0, 4)),
    ("within a time of a start", schedule.WITHIN_START, (1, 0, 0), (1, 0, 4)),
    ("not before", schedule.NOT_BEFORE, (0, 10, 0), (0, 5, 0)),
    ("not after", schedule.NOT_AFTER, (0, 0, 1), (0, 0, 5)),
)


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
    # a task that runs from 3 to 7, seen in its middle and when it does not run
    for text, row, bad, good in EXAMPLES:
        c.show(c.negation(c.define(schedule.row_holds, 5, row, 3, 7, *bad)), f"an example: {text}")
        for t, bounds in ((2, bad), (8, bad), (5, good)):
            at = c.define(schedule.row_holds, t, row, 3, 7, *bounds)
            c.show(at, f"an example: nothing against {text}")
