"""Replay of a solution: every leg, row, option and order, by the proved kernels, in integers."""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.assignment.earliest_times import rows_hold
from cratous.core.assignment.steps import chain_holds, wait_holds, weighted
from cratous.core.schedule.rows import eligible, later
from cratous.services.planning.assign_problem import Part, binding, parts
from cratous.spec.algebra import runs as algebra_runs
from cratous.spec.assignment.search import ORDER, AssignmentProblem, Choice, Step
from cratous.spec.errors import BadInput


def replayed(problem: AssignmentProblem, steps: Sequence[Step]) -> int:
    """The cost of the solution; BadInput with the reason if it is invalid."""
    branch = branch_of(problem, steps)
    chains: dict[int, list[Step]] = {v: [] for v in problem.vehicles}
    for step in steps:
        if step.vehicle_id not in chains:
            raise _wrong(f"there is no vehicle {step.vehicle_id}")
        chains[step.vehicle_id].append(step)
    last, team, added = 0, 0, 0
    for v, vehicle in enumerate(problem.vehicles):
        chain = chains[vehicle]
        legs = _legs(problem, v, chain)
        if not chain_holds([leg[:4] for leg in legs]):
            raise _wrong(f"vehicle {vehicle} cannot fly its tasks at these times")
        added += sum(leg[4] for leg in legs)
        if chain:
            last, team = later(last, chain[-1].end_ms), team + chain[-1].end_ms
    if not rows_hold(binding(problem, branch), *_times(problem, steps)):
        raise _wrong("an order or timing constraint does not hold")
    if problem.semantics == ORDER:
        order = tuple([task for task, _, _ in problem.done] + [step.task_id for step in steps])
        if not algebra_runs.complete(branch.term, order):
            raise _wrong("the tasks cannot be assigned in this order")
    return weighted(last, team, added, problem.cost.makespan, problem.cost.team)


def _times(
    problem: AssignmentProblem, steps: Sequence[Step]
) -> tuple[dict[int, int], dict[int, int]]:
    """Starts and ends by task, flown ones included."""
    starts = {task: start for task, start, _ in problem.done}
    ends = {task: end for task, _, end in problem.done}
    starts.update((step.task_id, step.start_ms) for step in steps)
    ends.update((step.task_id, step.end_ms) for step in steps)
    return starts, ends


def branch_of(problem: AssignmentProblem, steps: Sequence[Step]) -> Part:
    """The branch with these tasks whose rows hold; else any branch with these tasks."""
    done = {step.task_id for step in steps}
    if len(done) < len(steps):
        raise _wrong("a task is done twice")
    times = _times(problem, steps)
    same = [part for part in parts(problem)[0] if set(part.tasks) == done]
    for part in same:
        if rows_hold(binding(problem, part), *times):
            return part
    if not same:
        raise _wrong("the tasks are those of no branch of the relations")
    return same[0]


def _legs(
    problem: AssignmentProblem, v: int, chain: Sequence[Step]
) -> list[tuple[int, int, int, int, int]]:
    """(travel, start, end, duration, cost of the leg) for each of a vehicle's tasks."""
    legs, at, free = [], len(problem.choices), 0
    for step in chain:
        k, choice = _choice(problem, step)
        able = sum(1 << problem.vehicles.index(u) for u in choice.vehicles)
        way = problem.travel_ms[v][at][k]
        if way is None or not eligible(able, 1 << v):
            raise _wrong(f"vehicle {step.vehicle_id} cannot do task {step.task_id} there")
        travel = way + (problem.ready_ms[v] if at == len(problem.choices) else 0)
        wait = step.start_ms - (free + travel)
        if choice.lap_max_ms is not None:
            laps = -(-wait // max(1, choice.lap_max_ms))
            if not wait_holds(wait, laps, choice.lap_ms, choice.lap_max_ms):
                raise _wrong(
                    f"vehicle {step.vehicle_id} cannot wait {wait} ms before task {step.task_id}"
                )
        cost = 0
        for rows, weight in (
            (problem.distance_mm, problem.cost.distance), (problem.energy_mj, problem.cost.energy),
        ):  # fmt: skip
            if weight and rows:
                cost += weight * (rows[v][at][k] or 0)
        legs.append((travel, step.start_ms, step.end_ms, choice.duration_ms, cost))
        at, free = k, step.end_ms
    return legs


def _choice(problem: AssignmentProblem, step: Step) -> tuple[int, Choice]:
    for k, choice in enumerate(problem.choices):
        if (choice.task_id, choice.option_id) == (step.task_id, step.option_id):
            return k, choice
    raise _wrong(f"task {step.task_id} has no option {step.option_id}")


def _wrong(why: str) -> BadInput:
    return BadInput("this is no solution", item="steps", expected="a schedule that holds", got=why)


__all__ = ["branch_of", "replayed"]
