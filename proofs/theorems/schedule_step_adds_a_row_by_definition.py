"""With one row more the checker says that all hold exactly when all did before, the task of the row
runs at some instant and at none before mission start, and at no instant outside what the row
allows."""

from cratous.core.timing import schedule_step
from cratous.proofs.claim import Claim
from cratous.spec import schedule


def claim(c: Claim) -> None:
    ok = c.boolean("ok")
    row = tuple(c.integer(name) for name in ["kind", "start", "end", "ref", "lo", "hi"])
    _, start, end, *_ = row
    t, u = c.integer("t"), c.integer("u")
    held = c.use(schedule_step, ok, *row)
    witness = c.define(schedule.rows_hold_step, start, u, ok, *row)
    c.show(c.implies(held, witness), "if they hold, its start is an instant that shows it")
    # some t at which it runs, and the two instants that would show what is against it
    at_start = c.define(schedule.rows_hold_step, t, start, ok, *row)
    at_end = c.define(schedule.rows_hold_step, t, end, ok, *row)
    c.show(c.implies(c.all_of(at_start, at_end), held), "if not, start or end shows it")
