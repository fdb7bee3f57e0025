"""Evaluation of a schedule against its problem's meaning, on its own values: a valid one needs no solver."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cratous.services.planning.assign_logic import Known
from cratous.services.planning.assign_meaning import (
    chosen,
    flights,
    flown_after,
    meaning,
    windows,
)
from cratous.services.planning.assign_problem import Part
from cratous.services.planning.assign_replay import branch_of
from cratous.spec.assignment.search import AssignmentProblem, Step


def witnessed(problem: AssignmentProblem, steps: Sequence[Step]) -> bool:
    """Whether the schedule, with each vehicle flying its steps in order, satisfies all constraints.

    True is certain: every formula holds for these values. False only means that these values do not show it.
    """
    branch = branch_of(problem, steps)
    taken = [_choice(problem, branch, step) for step in steps]
    if None in taken:
        return False
    few = replace(branch, choices=tuple(k for k in taken if k is not None))
    logic = Known(_numbers(problem, steps), _truths(problem, few, steps))
    gone = [task for task, _, _ in problem.done]
    try:
        said = [f for _, f in meaning(logic, branch.term, problem.semantics, gone)]
        said += [f for _, f in windows(logic, problem, branch)]
        return all(said) and all(flights(logic, problem, few))
    except KeyError:  # a formula concerns something outside the schedule
        return False


def _choice(problem: AssignmentProblem, branch: Part, step: Step) -> int | None:
    """The index of the single choice that a step takes; None if it is ambiguous or of another vehicle."""
    able = [
        k for k in branch.choices
        if (problem.choices[k].task_id, problem.choices[k].option_id) == (step.task_id, step.option_id)
    ]  # fmt: skip
    if len(able) != 1 or step.vehicle_id not in problem.choices[able[0]].vehicles:
        return None
    return able[0]


def _numbers(problem: AssignmentProblem, steps: Sequence[Step]) -> dict[str, int]:
    """Starts, ends and positions of the tasks of the schedule and of the flown ones."""
    found: dict[str, int] = {}
    past = len(problem.done)
    for number, (task, begun, ended) in enumerate(problem.done):
        found |= {f"s{task}": begun, f"e{task}": ended, f"o{task}": number - past}
    for number, step in enumerate(steps):
        task = step.task_id
        found |= {f"s{task}": step.start_ms, f"e{task}": step.end_ms, f"o{task}": number}
    return found


def _truths(problem: AssignmentProblem, few: Part, steps: Sequence[Step]) -> dict[str, bool]:
    """The flight variables: each vehicle flies its steps in order, and nothing else."""
    last = len(problem.choices)
    vehicles = range(len(problem.vehicles))
    found = {chosen(k, v): False for k in few.choices for v in vehicles}
    found |= {
        flown_after(j, k, v): False for j in (*few.choices, last) for k in few.choices for v in vehicles
    }  # fmt: skip
    at = dict.fromkeys(problem.vehicles, last)
    for step, k in zip(steps, few.choices, strict=True):
        v = problem.vehicles.index(step.vehicle_id)
        found[chosen(k, v)] = found[flown_after(at[step.vehicle_id], k, v)] = True
        at[step.vehicle_id] = k
    return found
