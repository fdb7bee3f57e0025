"""What an assignment problem is, and what its search steps mean. Integers; times in milliseconds.

A problem: vehicles, options of tasks, the ways between them, relations as a process-algebra text,
a cost, and what the operators mean for times: `time` (`.` and `~` hold between the times of tasks,
on whatever vehicle) or `order` (they only restrict the order in which tasks are assigned, as
OpenUxAS does; timing suffixes hold in both). A vehicle may wait before any task; with `lap_ms` its
wait is none or a number of laps. The definitions below are what the kernels of
`core.assignment.steps` are proved against; instants and bounds stay below `TIME_LIMIT_MS`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

TIME, ORDER = "time", "order"
Rows = tuple[tuple[int | None, ...], ...]
"""One vehicle's ways: K + 1 rows (from each option's end, the last from its start), K columns."""


@dataclass(frozen=True)
class Choice:
    """One way to do a task. vehicles: ids of those that can; lap_max_ms None: any wait can be."""

    task_id: int
    option_id: int
    duration_ms: int
    vehicles: tuple[int, ...]
    lap_ms: int = 0
    lap_max_ms: int | None = None


@dataclass(frozen=True)
class Cost:
    """Weights, integers not below 0: of the latest end [per ms], of the sum of the vehicles' last
    ends [per ms], of the distance flown [per mm], of the energy used [per mJ]."""

    makespan: int = 1
    team: int = 0
    distance: int = 0
    energy: int = 0


MINMAX, CUMULATIVE = Cost(1, 0), Cost(0, 1)


@dataclass(frozen=True)
class AssignmentProblem:
    """An assignment problem, in the user's ids.

    travel_ms: per vehicle `Rows` over `choices`, None where there is no way; distance_mm,
    energy_mj: the same shape or empty; ready_ms: per vehicle; release_ms, due_ms: (task id, time);
    relations: empty means all tasks in any order; done: tasks that have been flown, as (task id,
    start, end), in the order of their starts: they have no choices, and no vehicle sets off before
    they have started; unable: further tasks that are asked for and nobody has a choice for, so that
    only branches without them count: none, if the relations are empty.
    """

    name: str
    vehicles: tuple[int, ...]
    ready_ms: tuple[int, ...]
    choices: tuple[Choice, ...]
    travel_ms: tuple[Rows, ...]
    relations: str = ""
    release_ms: tuple[tuple[int, int], ...] = ()
    due_ms: tuple[tuple[int, int], ...] = ()
    cost: Cost = MINMAX
    semantics: str = TIME
    distance_mm: tuple[Rows, ...] = ()
    energy_mj: tuple[Rows, ...] = ()
    done: tuple[tuple[int, int, int], ...] = ()
    unable: frozenset[int] = frozenset()

    @property
    def tasks(self) -> tuple[int, ...]:
        """The ids of all tasks, each once, in the order of the choices."""
        return tuple(dict.fromkeys(choice.task_id for choice in self.choices))


@dataclass(frozen=True)
class Step:
    """One task of a solution: who, by which option, and its times [ms]."""

    vehicle_id: int
    task_id: int
    option_id: int
    arrive_ms: int
    start_ms: int
    end_ms: int


@dataclass(frozen=True)
class Solution:
    """What a search found. status: `optimal` (with a certificate), `feasible`, `infeasible`
    (proved), `unknown`.

    steps: in an order of assignment; bound: nothing costs less, as far as was proved; trace: how
    the incumbent's cost fell, as (nodes, cost); counts: nodes, states.
    """

    status: str
    steps: tuple[Step, ...]
    cost: int | None
    bound: int
    nodes: int
    states: int
    trace: tuple[tuple[int, int], ...] = ()
    reasons: tuple[str, ...] = ()
    proof: object = field(default=None, compare=False, repr=False)

    @property
    def gap(self) -> float | None:
        """(cost - bound) / cost, or None without a solution."""
        if self.cost is None:
            return None
        return 0.0 if self.cost <= self.bound else (self.cost - self.bound) / self.cost


# ---- definitions ----------------------------------------------------------------------------


def may_start(t: int, free: int, travel: int, floor: int, ref: int) -> bool:
    """A vehicle that is free at `free` may start a task at the instant t: it has got there, no task
    placed later starts before the floor, and order and timing allow it. FOR ALL t."""
    there = t >= free + travel
    return there and t >= floor and t >= ref


def leaves_in_time(
    leave: int, start: int, due: int, after: int, release: int, duration: int, travel: int
) -> bool:
    """Leaving at `leave` and starting at `start`, the task is in time and so is what follows it.

    THERE IS a start: the departure is early enough. `after`: the latest departure from the task.
    """
    end = start + duration
    return start >= leave + travel and start >= release and end <= due and end <= after


def all_may_leave_at(leave: int, ok: bool, free: int, latest: int) -> bool:
    """All vehicles so far leave in time, and one more does at `leave`, when it is free and not after
    its latest departure. THERE IS an instant `leave`."""
    return ok and free <= leave and leave <= latest


def work_is_done(work: int, room: int, until: int, free: int) -> bool:
    """Vehicles so far have room for `room` ms of work, and one more is free at `free`: together they
    can do the work until `until`. What the others cannot do, this one begins when it is free."""
    rest = work - room
    return rest <= 0 or free + rest <= until


def all_is_done(room: int, work: int, done: int) -> bool:
    """What is done fits into the room, and nothing of the work is left. THERE IS such a `done`."""
    left = work - done
    return done <= room and left <= 0


def task_may_end(end: int, soonest: int, head: int, least: int) -> bool:
    """A task may end at `end`: no vehicle that could do it is through with it sooner than `soonest`,
    and it starts at `head` or later and takes at least `least`. FOR ALL ends."""
    return end >= soonest and end - least >= head


def ready(time: int, t: int) -> bool:
    """At the instant t this time of a state has come."""
    return time <= t


def is_covered_step(t: int, ok: bool, mine: int, other: int) -> bool:
    """So far the one state was ready wherever the other was, and so it is with this time of both,
    seen at the instant t. FOR ALL t."""
    return ok and not (ready(other, t) and not ready(mine, t))


def weighted(makespan: int, team: int, added: int, per_makespan: int, per_team: int) -> int:
    """The cost of a schedule: latest end and sum of last ends by their weights, and its legs."""
    return per_makespan * makespan + per_team * team + added


def leg_is_flown(leave: int, free: int, travel: int, start: int, end: int, duration: int) -> bool:
    """A vehicle that leaves at `leave`, not before it is free, is there by the start of the task,
    which takes its duration. THERE IS an instant `leave`."""
    return leave >= free and leave + travel <= start and end == start + duration


def row_is_raised(x: int, start: int, ref: int, lo: int) -> bool:
    """x keeps to the bounds so far and to the row: not before `start`, nor before ref + lo.
    FOR ALL x: this equals `x >= m` exactly for m the raised start."""
    return x >= start and x >= ref + lo


class Flown(NamedTuple):
    """A chain so far: every leg is flown, and when the last task ends [ms]."""

    ok: bool
    free: int


def chain_step(chain: Flown, leave: int, travel: int, start: int, end: int, duration: int) -> Flown:
    """One more task: the vehicle leaves at `leave`. THERE IS such an instant for every task."""
    return Flown(chain.ok and leg_is_flown(leave, chain.free, travel, start, end, duration), end)


def chain_result(chain: Flown) -> bool:
    """After the last task: every leg was flown. Nothing is quantified."""
    return chain.ok


def all_needed_done(k: int, done: int, need: int) -> bool:
    """If task number k is needed it is done. FOR ALL k in 0..61: the task that needs them opens."""
    return (need >> k) & 1 == 0 or (done >> k) & 1 == 1


def is_flown_in_laps(wait: int, laps: int, lap: int, lap_max: int, each: int, longer: int) -> bool:
    """The vehicle does not wait, or flies laps that together take as long as the wait: `longer` of them
    take 1 ms more than `each`, the others just that, and it can fly all of them. THERE ARE such
    numbers."""
    if wait == 0:
        return True
    longest = each
    if longer > 0:
        longest = each + 1
    possible = each >= lap and longest <= lap_max
    return longer >= 0 and longer < laps and possible and each * laps + longer == wait
