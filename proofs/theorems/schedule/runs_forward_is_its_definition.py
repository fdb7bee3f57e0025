"""A task's times are an interval for the kernel exactly when the task runs at some instant and at
none before mission start."""

from cratous.core.schedule.rows import runs_forward
from cratous.proofs.claim import Claim
from cratous.spec import schedule

EXAMPLES = (
    ("it runs at 4", (4, 5, 3, 7), True),
    ("it does not run at 2", (2, 5, 3, 7), False),
    ("it does not run at 8", (8, 5, 3, 7), False),
    ("it runs before mission start", (4, -1, -2, 7), False),
    ("it runs later than it is seen before mission start", (-2, -1, -2, 3), False),
    ("it is looked at before mission start when it has ended", (-6, -2, -6, -4), True),
    ("it runs after mission start as well", (4, 1, -2, 7), True),
    ("it does not run where it is looked at before mission start", (4, -3, -2, 7), True),
)


def claim(c: Claim) -> None:
    start, end, t, u = (c.integer(name) for name in ["start", "end", "t", "u"])
    ordered = c.use(runs_forward, start, end)
    witness = c.define(schedule.interval_is_ordered, start, u, start, end)
    c.show(c.implies(ordered, witness), "if it is, it runs at its start and never before 0")
    # some t at which it runs, and the two instants that would show a start before 0
    at_start = c.define(schedule.interval_is_ordered, t, start, start, end)
    at_end = c.define(schedule.interval_is_ordered, t, end, start, end)
    c.show(c.implies(c.all_of(at_start, at_end), ordered), "if it runs so, it is")
    for text, instants, said in EXAMPLES:
        c.show(
            c.same(c.define(schedule.interval_is_ordered, *instants), said), f"an example: {text}"
        )
