"""Why a wanted task has no vehicle: no vehicle can fly it, or none can reach it.

Determined from the inputs of planning, before any search.
"""

from __future__ import annotations

from cratous.services.mission.availability import JOINS_LATER
from cratous.services.planning.inputs import Inputs
from cratous.spec.mission.plan import NOT_THERE_YET


def why_none(inputs: Inputs) -> tuple[str, ...]:
    """A sentence for each task that no vehicle can do or reach."""
    none = {
        task: f"no vehicle can do {_named(inputs, task)}: {why}"
        for task, why in without_options(inputs).items()
    }
    unreached = {
        task: f"no vehicle can reach task {task}: {why}"
        for task, why in without_routes(inputs).items()
    }
    return tuple(why for _, why in sorted({**unreached, **none}.items()))


def unable(inputs: Inputs) -> dict[int, str]:
    """A reason for each task that no vehicle can do or reach, or that has ended undone."""
    return {
        **{task: f"it ended undone: {why}" for task, why in inputs.undone.items()},
        **{
            task: f"{NOT_THERE_YET if _not_there_yet(inputs, task) else 'no vehicle can do it'}: {why}"
            for task, why in without_options(inputs).items()
        },
        **{task: f"no vehicle can reach it: {why}" for task, why in without_routes(inputs).items()},
    }


def _named(inputs: Inputs, task_id: int) -> str:
    label = inputs.mission.task(task_id).label
    name = f"task {task_id}"
    return f"{name} ({label})" if label not in ("", name) else name


def without_options(inputs: Inputs) -> dict[int, str]:
    """For each wanted task that no vehicle can fly, what prevents the vehicles."""
    reasons = {}
    for task_id in inputs.wanted:
        if any(option.task_id == task_id for option in inputs.options):
            continue
        causes: dict[str, None] = {}
        for drop in inputs.dropped:
            if drop.task_id == task_id:
                causes.update((f"vehicle {v}: {drop.reason}", None) for v in drop.vehicles)
        said = "; ".join((*causes, *_absent(inputs, task_id)))
        reasons[task_id] = said or "no vehicle is eligible"
    return reasons


def without_routes(inputs: Inputs) -> dict[int, str]:
    """For each wanted task that no vehicle can reach, from its start or another task, what prevents the
    vehicles.
    """
    reasons = {}
    options, routes = inputs.options, inputs.routes
    for task_id in inputs.wanted:
        mine = [k for k, option in enumerate(options) if option.task_id == task_id]
        causes: dict[str, None] = {}
        reached = False
        for k in mine:
            for v, vehicle in enumerate(inputs.mission.vehicles):
                if vehicle.id not in options[k].vehicles:
                    continue
                before = [-1, *(j for j, other in enumerate(options) if other.task_id != task_id)]
                for j in before:
                    if routes.travel_ms(v, j, k) is not None:
                        reached = True
                        break
                if reached:
                    break
                causes[f"vehicle {vehicle.id}: {routes.route(v, -1, k).reason}"] = None
            if reached:
                break
        if mine and not reached:
            said = "; ".join((*causes, *_absent(inputs, task_id)))
            reasons[task_id] = said
    return reasons


def _not_there_yet(inputs: Inputs, task_id: int) -> bool:
    """Whether none of a task's eligible vehicles takes part yet, and one joins later."""
    eligible = inputs.mission.task(task_id).eligible
    here = any(not eligible or vehicle.id in eligible for vehicle in inputs.mission.vehicles)
    return not here and any(
        JOINS_LATER in why
        for vehicle, why in inputs.absent.items()
        if not eligible or vehicle in eligible
    )


def _absent(inputs: Inputs, task_id: int) -> list[str]:
    """The eligible vehicles that take no part, and why."""
    eligible = inputs.mission.task(task_id).eligible
    return [
        f"vehicle {vehicle}: {why}"
        for vehicle, why in inputs.absent.items()
        if not eligible or vehicle in eligible
    ]
