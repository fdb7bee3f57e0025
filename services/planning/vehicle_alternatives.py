"""What a plan would cost if another vehicle did a task.

For each vehicle the problem is solved again with the task restricted to it; for a partial plan, the problem
of the planned tasks.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cratous.services.planning import mission_assign, stages
from cratous.services.planning.assign import search
from cratous.services.planning.assign_problem import parts
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.partial import part_problem
from cratous.spec.assignment.search import AssignmentProblem
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import Plan, left_out_of


class Instead(NamedTuple):
    """The effect of giving a task to a vehicle. cost: of the whole plan, None if there is none; reason: why
    not, "" if possible; sure: whether the cost is proved minimal, or the absence of a plan certain.
    """

    vehicle: int
    cost: int | None
    reason: str
    sure: bool = True


def why(mission: Mission, plan: Plan, task: int, absent: dict[int, str]) -> tuple[Instead, ...]:
    """For each vehicle of a mission, the cost of the plan if it did the task; empty if the task is left out.

    BadInput if the mission has no such task, or another choice of the relations is planned.
    """
    if any(one.task_id == task for one in left_out_of(plan)):
        return ()
    planned = {item.task_id for item in plan.items}
    if task not in planned:
        raise BadInput(
            "no such task in the plan",
            item="--why",
            expected="one of " + ", ".join(map(str, sorted(planned))),
            got=str(task),
        )
    inputs = Inputs(mission, stages.start_poses(mission), absent=absent)
    problem = part_problem(inputs.problem(inputs.routes.travel_ms), planned)
    found = [_with(mission, problem, inputs, task, vehicle.id) for vehicle in mission.vehicles]
    return (*found, *(Instead(vehicle, None, reason) for vehicle, reason in absent.items()))


def _with(
    mission: Mission, problem: AssignmentProblem, inputs: Inputs, task: int, vehicle: int
) -> Instead:
    """The result with a task restricted to one vehicle."""
    choices = tuple(
        choice
        if choice.task_id != task
        else replace(choice, vehicles=tuple(v for v in choice.vehicles if v == vehicle))
        for choice in problem.choices
    )
    if not any(choice.vehicles for choice in choices if choice.task_id == task):
        said = [d.reason for d in inputs.dropped if d.task_id == task and vehicle in d.vehicles]
        return Instead(vehicle, None, "; ".join(dict.fromkeys(said)) or "it is not eligible")
    asked = replace(problem, choices=choices)
    solved = search(asked, mission_assign.limits_of(mission), *parts(asked))
    if solved.cost is None:
        certain = solved.status == "infeasible"
        none = "there is no schedule with it" if certain else "no schedule was found with it"
        return Instead(vehicle, None, none, certain)
    return Instead(vehicle, solved.cost, "", solved.bound >= solved.cost)
