"""For a task that was not served: whether any vehicle could have served it, as far as is known.

Judged from the mission alone: which vehicles take part when, are eligible, and able in the wind.
Whether a route and enough time were left is for the planner, which the monitor does not repeat:
that remains undetermined.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cratous.core.schedule.rows import runs_forward
from cratous.services.mission.availability import absent
from cratous.services.monitor.landing import Down
from cratous.services.monitor.outside import outside_zones
from cratous.spec.mission import Mission, Task
from cratous.spec.mission.changes import TASK_ADDED, split

OPEN = "not determined"


def prospects(
    mission: Mission, task: Task, end_ms: int, down: Mapping[int, Down]
) -> tuple[str, dict[str, Any]]:
    """Whether the task could have been served, and the state of each vehicle at the end, in words
    and as data. down: vehicles on the ground.
    """
    why = _unable(mission, task, end_ms, down)
    vehicles = [
        {"vehicle": v.id, "unable": why.get(v.id, "")}
        for v in sorted(mission.vehicles, key=lambda v: v.id)
    ]
    able = [v["vehicle"] for v in vehicles if not v["unable"]]
    if able:
        names = ", ".join(f"vehicle {number}" for number in able)
        text = f"{names} could do it at the end; whether a way and the time were left is {OPEN}"
        found = {"could_be_served": OPEN, "since_ms": None, "vehicles": vehicles}
        cut = outside_zones(mission, task, end_ms)
        return "; ".join((text, *cut.words)), {
            **found,
            "outside_zones": cut.data,
        } if cut.data else found
    since_ms, asked_ms = _since(mission, task, end_ms, down), _asked(mission, task)
    said = "; ".join(f"vehicle {v['vehicle']}: {v['unable']}" for v in vehicles)
    never = runs_forward(since_ms, asked_ms)
    text = f"no vehicle could do it from {max(since_ms, asked_ms) / 1000:.2f} s on: {said}"
    if not never:
        text += f"; whether it could have been done before is {OPEN}"
    answer = "no" if never else OPEN
    return text, {"could_be_served": answer, "since_ms": since_ms, "vehicles": vehicles}


def _unable(mission: Mission, task: Task, now_ms: int, down: Mapping[int, Down]) -> dict[int, str]:
    """Vehicles that cannot perform a task at an instant, with the reason."""
    away = absent(mission, now_ms)
    found = {}
    for vehicle in mission.vehicles:
        if task.eligible and vehicle.id not in task.eligible:
            found[vehicle.id] = "it is not eligible"
        elif vehicle.id in away:
            found[vehicle.id] = away[vehicle.id]
        elif vehicle.id in down and runs_forward(down[vehicle.id].since_ms, now_ms):
            found[vehicle.id] = f"it {down[vehicle.id].words()}"
    return found


def _since(mission: Mission, task: Task, end_ms: int, down: Mapping[int, Down]) -> int:
    """Time from which no vehicle could perform the task until the end of the mission [ms]."""
    happened, _ = split(mission.changes, end_ms)
    landed = (place.since_ms for place in down.values())
    instants = sorted({0, *(change.at_ms for change in happened), *landed}, reverse=True)
    since = end_ms
    for instant in instants:
        if len(_unable(mission, task, instant, down)) < len(mission.vehicles):
            break
        since = instant
    return since


def _asked(mission: Mission, task: Task) -> int:
    """Time at which the task was first requested [ms]."""
    added = [c.at_ms for c in mission.changes if c.kind == TASK_ADDED and c.task == task.id]
    return min(added, default=0)
