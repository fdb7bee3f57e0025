"""A mission's assignment: its problem, solved and certified, and checked again by z3.

The problem uses the mission's ids; the result uses indices of its vehicles and options. A returned result has
passed the proved checker (`replayed`) and z3 on the mission's constraints, and its certificate has been
checked; a plan is called optimal only on that basis.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from cratous.core.assignment.problem import START, Assignment, Branch, Fixed, Placed
from cratous.services.planning import reasons
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_certificate import certified, verify
from cratous.services.planning.assign_problem import binding
from cratous.services.planning.assign_replay import branch_of
from cratous.services.planning.options import Option
from cratous.spec.algebra import Term, format_term
from cratous.spec.algebra.meaning import tasks as tasks_of
from cratous.spec.assignment.search import (
    CUMULATIVE,
    MINMAX,
    AssignmentProblem,
    Choice,
    Cost,
    Rows,
    Solution,
)
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Vehicle
from cratous.spec.mission.plan import InPart, LeftOut

NODES = 1_000_000
"""Search nodes of a mission without a limit of its own, a few seconds at most."""
WIDTH = 50_000
"""States kept per layer."""
COSTS = {
    "MINMAX": MINMAX,
    "CUMULATIVE": CUMULATIVE,
    "DISTANCE": Cost(0, 0, 1, 0),
    "ENERGY": Cost(0, 0, 0, 1),
}
Travel = Callable[[int, int, int], int | None]
"""(vehicle, option before or START, option) -> travel time [ms], None if there is no route."""


@dataclass(frozen=True)
class Found:
    """The assignment with its certificate; or none, with the reasons.

    left_out: requested tasks that it does not contain; sure: whether, as far as was searched, no more can be
    done.
    """

    assignment: Assignment | None
    certificate: dict[str, Any] | None
    reasons: tuple[str, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    sure: bool = True


def problem_of(
    mission: Mission,
    term: Term,
    options: Sequence[Option],
    travel_ms: Travel,
    fixed: Sequence[Fixed] = (),
    now_ms: int = 0,
) -> AssignmentProblem:
    """The assignment problem for the remaining tasks of a mission."""
    masks = {task.id: task.eligible for task in mission.tasks}
    ids = tuple(vehicle.id for vehicle in mission.vehicles)
    choices = tuple(
        Choice(
            o.task_id, o.option_id, o.duration_ms,
            tuple(v for v in ids if v in o.vehicles and (v in masks[o.task_id] or not masks[o.task_id])),
            o.lap_ms, o.lap_max_ms,
        )
        for o in options
    )  # fmt: skip
    count = len(options)
    travel = tuple(
        _times(travel_ms, v, [v_id in choice.vehicles for choice in choices])
        for v, v_id in enumerate(ids)
    )
    weighed = COSTS[mission.cost]
    distance, energy = tuple[Rows, ...](), tuple[Rows, ...]()
    if weighed.distance:
        distance = tuple(
            _per_ms(rows, options, [o.flyer.speed_m_s for o in options]) for rows in travel
        )
    if weighed.energy:
        energy = tuple(
            _per_ms(rows, options, [power_w(vehicle)] * count)
            for rows, vehicle in zip(travel, mission.vehicles, strict=True)
        )
    known = {c.task_id for c in choices} | {f.task_id for f in fixed}
    # both forms of "all tasks, in any order" are one problem, with the tasks in the same order
    relations = mission.relations if mission.relations.strip() else format_term(term)
    done = sorted(fixed, key=lambda f: (f.start_ms, f.end_ms, f.task_id))
    return AssignmentProblem(
        mission.name, ids, (now_ms,) * len(ids), choices, travel, relations,
        cost=weighed, semantics=mission.order, distance_mm=distance, energy_mj=energy,
        done=tuple((f.task_id, f.start_ms, f.end_ms) for f in done),
        unable=frozenset(tasks_of(term)) - known,
    )  # fmt: skip


def power_w(vehicle: Vehicle) -> float:
    """Power consumption of a vehicle in flight [W]; BadInput if the mission does not give it."""
    if vehicle.power_w is None:
        raise BadInput(
            "the cost ENERGY needs what each vehicle draws in flight",
            item=f"power_w of vehicle {vehicle.id}",
            expected="a number of watts",
            got="nothing",
        )
    return vehicle.power_w


def _times(travel_ms: Travel, vehicle: int, able: Sequence[bool]) -> Rows:
    """The travel times of a vehicle, from each option and from its start, to each option that it may do."""
    every = range(len(able))
    return tuple(
        tuple([travel_ms(vehicle, a, k) if able[k] else None for k in every])
        for a in (*every, START)
    )


def _per_ms(rows: Rows, options: Sequence[Option], rates: Sequence[float]) -> Rows:
    """Travel plus task, in units of a rate per millisecond: m/s gives mm, W gives mJ."""
    return tuple(
        tuple(
            None if ms is None else round((ms + o.duration_ms) * rate)
            for ms, o, rate in zip(row, options, rates, strict=True)
        )
        for row in rows
    )


def limits_of(mission: Mission) -> Limits:
    """Search limits of a mission, in nodes rather than seconds: a plan must not depend on the machine's
    speed.
    """
    nodes = NODES if mission.node_limit is None else mission.node_limit
    return Limits(nodes=nodes, gap=mission.gap, width=WIDTH)


def assign(problem: AssignmentProblem, limits: Limits, *, tell: bool = True) -> Found:
    """The best assignment within the limits. BadInput for an invalid problem.

    tell: if there is none, find the reasons, which takes far longer than finding that there is none.
    """
    found = solve(problem, limits)
    if found.cost is None:
        return Found(None, None, reasons.timing_reasons(problem, found) if tell else ())
    solution, certificate = certified(problem, found, solvers=False)
    verdict = verify(certificate)
    if verdict.wrong:
        raise RuntimeError(f"the plan does not pass its own check: {verdict.wrong}")
    return Found(indexed(problem, solution, certificate["sha256"]), certificate)


def indexed(problem: AssignmentProblem, solution: Solution, digest: str) -> Assignment:
    """A solution in indices, each vehicle's tasks in the order of flight."""
    part = branch_of(problem, solution.steps)
    number = {(c.task_id, c.option_id): k for k, c in enumerate(problem.choices)}
    free = list(problem.ready_ms)
    placed = []
    for step in solution.steps:
        v = problem.vehicles.index(step.vehicle_id)
        k = number[step.task_id, step.option_id]
        placed.append(Placed(v, k, free[v], step.arrive_ms, step.start_ms, step.end_ms))
        free[v] = step.end_ms
    tasks = (*(task for task, _, _ in part.done), *part.tasks)
    assert solution.cost is not None
    return Assignment(
        Branch(tasks, binding(problem, part)), tuple(placed), solution.cost, solution.bound,
        solution.status, solution.nodes, digest,
    )  # fmt: skip


def parts_in(options: Sequence[Option], assignment: Assignment | None) -> Iterator[InPart]:
    """The tasks that an assignment does in part, by task id."""
    placed = () if assignment is None else assignment.placed
    for option in sorted((options[one.candidate] for one in placed), key=lambda o: o.task_id):
        if option.part is not None:
            yield option.part
