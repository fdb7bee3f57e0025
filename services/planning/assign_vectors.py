"""Assignment problems as published in JSON: two forms, read into `AssignmentProblem`.

*Chains* (`process_algebra`, `travel_ms`, `start_cost_ms`): one option for each task, one speed.
*Cost matrix* (`task_relationships`, `cost_matrix`): rows (vehicle, task, option, task, option, ms)
as the message AssignmentCostMatrix has them; from task 0, option 0 means from the start.
"""

from __future__ import annotations

from typing import Any

from cratous.services.planning.assign_problem import check
from cratous.spec import algebra
from cratous.spec.assignment import MINMAX, AssignmentProblem, Choice, Cost
from cratous.spec.errors import BadInput


def read(
    data: dict[str, Any], semantics: str, cost: Cost = MINMAX, name: str = ""
) -> AssignmentProblem:
    """The problem of one JSON object; BadInput for one that is none, with the item."""
    try:
        if "cost_matrix" in data:
            problem = _matrix(data, semantics, cost, name)
        else:
            problem = _chains(data, semantics, cost, name)
    except KeyError as error:
        raise BadInput("a field is missing", item=str(error.args[0]), expected="it") from error
    except (TypeError, IndexError, AttributeError) as error:
        raise BadInput(f"this is no assignment problem: {error}") from error
    check(problem)
    return problem


def _chains(data: dict[str, Any], semantics: str, cost: Cost, name: str) -> AssignmentProblem:
    vehicles = tuple(v["id"] for v in data["vehicles"])
    choices = tuple(
        Choice(t["id"], 1, t["duration_ms"], tuple(t["eligible"])) for t in data["tasks"]
    )
    between = tuple(tuple(row) for row in data["travel_ms"])
    travel = tuple((*between, tuple(start)) for start in data["start_cost_ms"])
    return AssignmentProblem(
        name or str(data.get("name", "")), vehicles, (0,) * len(vehicles), choices, travel,
        data["process_algebra"], cost=cost, semantics=semantics,
    )  # fmt: skip


def _matrix(data: dict[str, Any], semantics: str, cost: Cost, name: str) -> AssignmentProblem:
    vehicles = tuple(data["vehicles"])
    choices = []
    for task in data["tasks"]:
        listed = {o["option"] for o in task["options"]}
        _composition(task["task"], task["composition"], listed)
        for o in task["options"]:
            able = tuple(v for v in o["eligible"] if v in vehicles) or ()
            choices.append(Choice(task["task"], o["option"], o["cost_ms"], able))
    number = {(c.task_id, c.option_id): k for k, c in enumerate(choices)}
    number[0, 0] = len(choices)
    rows: list[list[list[int | None]]] = [
        [[None] * len(choices) for _ in range(len(choices) + 1)] for _ in vehicles
    ]
    for vehicle, task, option, to_task, to_option, time in data["cost_matrix"]:
        if vehicle not in vehicles:
            raise BadInput("no such vehicle", item="cost_matrix", got=str(vehicle))
        a, b = number.get((task, option)), number.get((to_task, to_option))
        if a is None or b is None or b == len(choices):
            raise BadInput(
                "no such task option",
                item="cost_matrix",
                got=str((task, option, to_task, to_option)),
            )
        rows[vehicles.index(vehicle)][a][b] = time
    travel = tuple(tuple(tuple(row) for row in table) for table in rows)
    return AssignmentProblem(
        name or str(data.get("name", "")), vehicles, (0,) * len(vehicles), tuple(choices), travel,
        data["task_relationships"], cost=cost, semantics=semantics,
    )  # fmt: skip


def _composition(task: int, text: str, listed: set[int]) -> None:
    """A task's composition has to be a choice of one of its options."""
    item = f"composition of task {task}"
    term = algebra.parse(text, where=item)
    flat = isinstance(term, algebra.Atom) or (
        term.op == algebra.ALTERNATIVE and all(isinstance(o, algebra.Atom) for o in term.operands)
    )
    named = {atom.task for atom in algebra.atoms(term)}
    if not flat or named != listed:
        raise BadInput(
            "this composition is out of reach", item=item,
            expected="one + over all options of the task", got=text.strip(),
        )  # fmt: skip
