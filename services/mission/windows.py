"""Time windows of a plan's tasks, from the timing of its relations: for display only."""

from __future__ import annotations

from functools import reduce
from typing import NamedTuple

from cratous.core.schedule.rows import earlier, later
from cratous.services.mission.times import reference_ms
from cratous.spec.constraint_rows import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
    Row,
)
from cratous.spec.mission.plan import Plan

LATEST = (WITHIN_END, WITHIN_START, NOT_AFTER)
EARLIEST = (AFTER_END, AFTER_START, NOT_BEFORE)


class Window(NamedTuple):
    """A task must start at from_ms or later and end at to_ms or earlier, both after mission start.

    Bounds relative to other tasks use the plan's times. texts: their origin, in the user's words.
    """

    task: int
    from_ms: int
    to_ms: int
    texts: tuple[str, ...]


def windows(plan: Plan) -> tuple[Window, ...]:
    """The windows of the planned tasks whose end is bounded, by id."""
    times = {item.task_id: (item.start_ms, item.end_ms) for item in plan.items}
    of: dict[int, list[Row]] = {task: [] for task in sorted(times)}
    for row in plan.rows:
        if row.i in of and all(task in times for task in row.group):
            of[row.i].append(row)
    found = []
    for task, rows in of.items():
        ends = [reference_ms(row, times) + row.hi for row in rows if row.kind in LATEST]
        starts = [reference_ms(row, times) + row.lo for row in rows if row.kind in EARLIEST]
        if ends:
            texts = tuple(dict.fromkeys(row.text for row in rows))
            found.append(Window(task, reduce(later, starts, 0), reduce(earlier, ends), texts))
    return tuple(found)
