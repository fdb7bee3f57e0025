"""With one row more the checker says that all hold exactly when all did before, the task of the row
runs at some instant and at none before mission start, and at no instant outside what the row
allows."""

from cratous.core.schedule.rows import schedule_step
from cratous.proofs.claim import Claim
from cratous.spec import schedule

# a task that may not run before 0: the instants t and u, its start and end, and whether all is well
SEEN = (
    ("when it runs", (4, 5, 3, 7), True),
    ("at a t at which it does not run yet", (2, 5, 3, 7), False),
    ("at a t at which it has ended", (8, 5, 3, 7), False),
    ("after mission start, though it started before", (4, 4, -2, 7), True),
    ("before mission start", (4, -1, -2, 7), False),
)


def claim(c: Claim) -> None:
    ok = c.boolean("ok")
    row = schedule.Timed(*[c.integer(name) for name in ["kind", "start", "end", "ref", "lo", "hi"]])
    start, end = row.start, row.end
    t, u = c.integer("t"), c.integer("u")
    held = c.use(schedule_step, ok, *row)
    witness = c.define(schedule.rows_hold_step, start, u, ok, row)
    c.show(c.implies(held, witness), "if they hold, its start is an instant that shows it")
    # some t at which it runs, and the two instants that would show what is against it
    at_start = c.define(schedule.rows_hold_step, t, start, ok, row)
    at_end = c.define(schedule.rows_hold_step, t, end, ok, row)
    c.show(c.implies(c.all_of(at_start, at_end), held), "if not, start or end shows it")
    for text, (t, u, start, end), said in SEEN:
        one = schedule.Timed(schedule.NOT_BEFORE, start, end, 0, 0, 0)
        held = c.define(schedule.rows_hold_step, t, u, True, one)
        c.show(c.same(held, said), f"an example: seen {text}")
