"""Comparison of the assignment reported by UxAS with the checked plan."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.timeliness import in_time
from cratous.spec.mission.plan import Plan

ROUNDED_MS = 500
"""UxAS plans from degrees in another frame, so its times may differ by this much [ms]."""


def agrees(plan: Plan, summary: Any) -> str:
    """The first difference between a TaskAssignmentSummary and the plan, in words; "" if they agree."""
    said: dict[int, list[Any]] = {}
    for one in summary.TaskList:
        said.setdefault(one.AssignedVehicle, []).append(one)
    for vehicle in sorted({*said, *(item.vehicle_id for item in plan.items)}):
        wanted, got = plan.chain(vehicle), said.get(vehicle, [])
        orders = [(i.task_id, i.option_id) for i in wanted], [(t.TaskID, t.OptionID) for t in got]
        if orders[0] != orders[1]:
            return f"vehicle {vehicle} has {_words(orders[1])}, expected {_words(orders[0])}"
        for item, one in zip(wanted, got, strict=True):
            first, last = sorted((item.end_ms, one.TimeTaskCompleted))
            if not in_time(first, last, ROUNDED_MS):
                return (
                    f"task {item.task_id} ends after {one.TimeTaskCompleted / 1000:.3f} s, "
                    f"expected {item.end_ms / 1000:.3f} s"
                )
    return ""


def _words(order: list[tuple[int, int]]) -> str:
    return " ".join(f"p{task} (option {option})" for task, option in order) or "no task"
