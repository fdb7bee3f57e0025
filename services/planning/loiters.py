"""The loiters of an assignment: where and when each vehicle waits so that all relations hold.

Given are the assignment, its order, and an earliest start for each task. The times are the best schedule of
these chains under the relations (`core.assignment.earliest_times`, by the proved kernel `raised`); it is used
only if the proved checker accepts it (`replayed`: legs, laps, order, timing). Before a task a vehicle waits
not at all or in whole laps of a circle at the task's start. Times in ms after mission start.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.assignment.earliest_times import Unmet, earliest
from cratous.core.assignment.instance import TIME_MAX_MS
from cratous.core.assignment.settlement import Settler
from cratous.core.schedule.rows import runs_forward
from cratous.services.planning.assign_problem import Part, arrays, binding, parts
from cratous.services.planning.assign_replay import replayed
from cratous.services.planning.options import Option
from cratous.services.planning.stages import hold_of
from cratous.spec.assignment.search import AssignmentProblem, Step
from cratous.spec.constraint_rows import NOT_BEFORE, Row
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Zone
from cratous.spec.mission.plan import Hold


class Given(NamedTuple):
    """One task of an assignment. not_before_ms: assigned earliest start, or 0."""

    vehicle_id: int
    task_id: int
    option_id: int
    not_before_ms: int


class Loiter(NamedTuple):
    """A vehicle waits before a task: on `hold` from its arrival to the start of the task [ms]."""

    vehicle_id: int
    task_id: int
    arrive_ms: int
    start_ms: int
    hold: Hold
    speed_m_s: float

    @property
    def wait_ms(self) -> int:
        """The time between arrival and start [ms]."""
        return self.start_ms - self.arrive_ms


def schedule(problem: AssignmentProblem, given: Sequence[Given]) -> tuple[Step, ...]:
    """The times of an assignment. NoPlan with the constraint that cannot be met; BadInput for an invalid
    assignment.
    """
    done = [item.task_id for item in given]
    index = {(c.task_id, c.option_id): k for k, c in enumerate(problem.choices)}
    for k, item in enumerate(given):
        if item.vehicle_id not in problem.vehicles or (item.task_id, item.option_id) not in index:
            raise BadInput(
                "an assignment of what is not there",
                item=f"TaskList[{k}]",
                expected="a vehicle and an option of the request",
                got=f"vehicle {item.vehicle_id}, task {item.task_id}, option {item.option_id}",
            )
        if not runs_forward(item.not_before_ms, TIME_MAX_MS - 1):
            raise BadInput(
                "no such start",
                item=f"TaskList[{k}].TimeThreshold",
                expected=f"0 ms or more, less than {TIME_MAX_MS} ms",
                got=str(item.not_before_ms),
            )
    same = [part for part in parts(problem)[0] if set(part.tasks) == set(done)]
    if len(set(done)) < len(done) or not same:
        raise BadInput(
            "these are the tasks of no branch of the relations",
            item="TaskList",
            expected="each task of a branch, once",
            got=", ".join(map(str, done)) or "no task",
        )
    clashes = []
    for part in same:
        found = _timed(problem, part, given, index)
        if isinstance(found, str):
            clashes.append(found)
        else:
            replayed(problem, found)
            return found
    raise NoPlan(tuple(dict.fromkeys(clashes)))


def _timed(
    problem: AssignmentProblem,
    part: Part,
    given: Sequence[Given],
    index: dict[tuple[int, int], int],
) -> tuple[Step, ...] | str:
    """The steps at their best times under the rows of a branch, or the constraint that cannot be met."""
    instance = arrays(problem, part)
    place = {k: o for o, k in enumerate(part.choices)}
    moves = [
        (problem.vehicles.index(item.vehicle_id), place[index[item.task_id, item.option_id]])
        for item in given
    ]
    at = [instance.duration.size] * instance.vehicles
    for item, (v, o) in zip(given, moves, strict=True):
        choice = problem.choices[part.choices[o]]
        before = len(problem.choices) if at[v] == instance.duration.size else part.choices[at[v]]
        way = problem.travel_ms[v][before][part.choices[o]]
        if item.vehicle_id not in choice.vehicles:
            return f"vehicle {item.vehicle_id} is not eligible for task {item.task_id}"
        if way is None:
            return f"the costs have no way of vehicle {item.vehicle_id} to task {item.task_id}"
        at[v] = o
    laps = tuple((problem.choices[k].lap_ms, problem.choices[k].lap_max_ms) for k in part.choices)
    floors = tuple(
        Row(NOT_BEFORE, i.task_id, (), i.not_before_ms, 0, f"task {i.task_id} was assigned a start")
        for i in given
    )
    rows = (*binding(problem, part), *floors)
    rules = Settler(instance, None, part.tasks, rows, laps, part.done)
    times = earliest(rules.visits(moves), rows)
    if isinstance(times, Unmet):
        return times.violated.text
    shift = len(part.done)
    return tuple(
        Step(
            i.vehicle_id, i.task_id, i.option_id, times.arrive_ms[k], times.start_ms[k],
            times.end_ms[k],
        )
        for k, i in enumerate(given, shift)
    )  # fmt: skip


def loiters_of(
    steps: Sequence[Step], options: Sequence[Option], zones: Sequence[Zone]
) -> tuple[Loiter, ...]:
    """The loiters of a schedule, in order of their beginning. NoPlan where there is no room."""
    by_id = {(option.task_id, option.option_id): option for option in options}
    made = []
    for step in steps:
        wait = step.start_ms - step.arrive_ms
        if not wait:
            continue
        option = by_id[step.task_id, step.option_id]
        hold = hold_of(option, wait, zones)
        if hold is None:
            raise NoPlan(
                (
                    f"vehicle {step.vehicle_id} has to wait {wait / 1000:.3f} s before task "
                    f"{step.task_id}, and no hold circle there obeys the zones",
                )
            )
        made.append(
            Loiter(
                step.vehicle_id, step.task_id, step.arrive_ms, step.start_ms, hold,
                option.flyer.speed_m_s,
            )
        )  # fmt: skip
    return tuple(sorted(made, key=lambda loiter: (loiter.arrive_ms, loiter.vehicle_id)))
