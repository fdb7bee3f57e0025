"""The schedule checker accepts a schedule exactly when every row holds at every instant and every task's
times are an interval, for every number of rows; a task's start and end are the instants that decide it."""

from typing import Any

from cratous.core.schedule.rows import schedule_holds
from cratous.proofs.claim import Claim
from cratous.spec.schedule import Timed, rows_hold_step


def model_step(ok: Any, kind: Any, start: Any, end: Any, ref: Any, lo: Any, hi: Any) -> Any:
    row = Timed(kind, start, end, ref, lo, hi)
    return rows_hold_step(start, start, ok, row) and rows_hold_step(start, end, ok, row)


def claim(c: Claim) -> None:
    values = tuple(c.integer(name) for name in ["kind", "start", "end", "ref", "lo", "hi"])
    row = Timed(*values)
    start, end = row.start, row.end
    t, u, before = c.integer("t"), c.integer("u"), c.boolean("before")
    seen = c.define(model_step, before, *values)
    everywhere = c.define(rows_hold_step, start, u, before, row)
    c.show(c.implies(seen, everywhere), "what holds at the two instants holds at every one")
    at_start = c.define(rows_hold_step, t, start, before, row)
    at_end = c.define(rows_hold_step, t, end, before, row)
    c.show(c.implies(c.all_of(at_start, at_end), seen), "from whatever instant it is seen")
    c.fold(
        schedule_holds,
        acc=c.boolean("ok"),
        model=c.boolean("all_hold"),
        item=values,
        context=(),
        model_start=True,
        model_step=model_step,
        relation=c.same,
    )
