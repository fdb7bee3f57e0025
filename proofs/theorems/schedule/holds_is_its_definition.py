"""The schedule checker accepts a schedule exactly when every row holds and every task's times are an
interval, seen at the instants that decide it: its start and its end; for every number of rows."""

from typing import Any

from cratous.core.schedule.rows import schedule_holds
from cratous.proofs.claim import Claim
from cratous.spec.schedule import rows_hold_result, rows_hold_step


def model_step(ok: Any, kind: Any, start: Any, end: Any, ref: Any, lo: Any, hi: Any) -> Any:
    at_start = rows_hold_step(start, start, ok, kind, start, end, ref, lo, hi)
    return at_start and rows_hold_step(start, end, ok, kind, start, end, ref, lo, hi)


def claim(c: Claim) -> None:
    values = tuple(c.integer(name) for name in ["kind", "start", "end", "ref", "lo", "hi"])
    c.fold(
        schedule_holds,
        acc=c.boolean("ok"),
        model=c.boolean("all_hold"),
        item=values,
        context=(),
        model_start=True,
        model_step=model_step,
        model_finish=rows_hold_result,
        relation=c.same,
    )
