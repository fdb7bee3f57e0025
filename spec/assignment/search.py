"""What an assignment problem is, and what its search steps mean. Integers; times in milliseconds.

A problem consists of vehicles, options of tasks, the legs between them, relations as a process-algebra text, a cost,
and a semantics of the operators: `time` (`.` and `~` constrain the times of tasks, on whatever vehicle) or `order`
(they only restrict the order in which tasks are assigned, as OpenUxAS does; timing suffixes apply in both). A vehicle
may wait before any task; with `lap_ms` its wait is zero or a whole number of laps. The kernels of
`core.assignment.steps` are proved against the definitions below; instants and bounds stay below `TIME_LIMIT_MS`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

TIME, ORDER = "time", "order"
Rows = tuple[tuple[int | None, ...], ...]
"""One vehicle's legs: K + 1 rows (from each option's end; the last row from its start), K columns."""


@dataclass(frozen=True)
class Choice:
    """One option of a task. vehicles: ids of those that can fly it; lap_max_ms: None permits any wait."""

    task_id: int
    option_id: int
    duration_ms: int
    vehicles: tuple[int, ...]
    lap_ms: int = 0
    lap_max_ms: int | None = None


@dataclass(frozen=True)
class Cost:
    """Weights, non-negative integers: of the latest end [per ms], of the sum of the vehicles' last ends [per ms], of
    the distance flown [per mm], of the energy used [per mJ].
    """

    makespan: int = 1
    team: int = 0
    distance: int = 0
    energy: int = 0


MINMAX, CUMULATIVE = Cost(1, 0), Cost(0, 1)


@dataclass(frozen=True)
class AssignmentProblem:
    """An assignment problem, in the user's ids.

    travel_ms: per vehicle `Rows` over `choices`, None where there is no route; distance_mm, energy_mj: the same
    shape, or empty; ready_ms: per vehicle; release_ms, due_ms: (task id, time); relations: empty means all tasks in
    any order; done: tasks already flown, as (task id, start, end), ordered by start: they have no choices, and no
    vehicle departs before they have started; unable: further requested tasks that have no choice, so that only
    branches without them count (without relations there is no such branch).
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
    """One task of a solution: vehicle, option and times [ms]."""

    vehicle_id: int
    task_id: int
    option_id: int
    arrive_ms: int
    start_ms: int
    end_ms: int


@dataclass(frozen=True)
class Solution:
    """The result of a search. status: `optimal` (with a certificate), `feasible`, `infeasible` (proved), `unknown`.

    steps: in an order of assignment; bound: the proved lower bound of the cost; trace: the incumbent's cost over the
    search, as (nodes, cost); counts: nodes, states.
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
    """A vehicle that is free at `free` may start a task at the instant t: it has arrived, t is not before the floor
    (no task assigned later starts earlier), and order and timing allow it. FOR ALL t.
    """
    there = t >= free + travel
    return there and t >= floor and t >= ref


def leaves_in_time(
    leave: int, start: int, due: int, after: int, release: int, duration: int, travel: int
) -> bool:
    """Leaving at `leave` and starting at `start`, the task is on time and so is what follows it.

    THERE IS a start: the departure is early enough. `after`: the latest departure from the task.
    """
    end = start + duration
    return start >= leave + travel and start >= release and end <= due and end <= after


def all_may_leave_at(leave: int, ok: bool, free: int, latest: int) -> bool:
    """All vehicles so far leave in time, and one more does so at `leave`: not before it is free and not after its
    latest departure. THERE IS an instant `leave`.
    """
    return ok and free <= leave and leave <= latest


def work_is_done(work: int, room: int, until: int, free: int) -> bool:
    """The vehicles so far have capacity for `room` ms of work, and one more is free at `free`: together they can
    complete the work by `until`. This vehicle takes over what exceeds `room` once it is free.
    """
    rest = work - room
    return rest <= 0 or free + rest <= until


def all_is_done(room: int, work: int, done: int) -> bool:
    """The work done fits into the room, and no work remains. THERE IS such a `done`."""
    left = work - done
    return done <= room and left <= 0


def task_may_end(end: int, soonest: int, head: int, least: int) -> bool:
    """A task may end at `end`: no vehicle that could fly it finishes sooner than `soonest`, and it starts at `head`
    or later and takes at least `least`. FOR ALL ends.
    """
    return end >= soonest and end - least >= head


def ready(time: int, t: int) -> bool:
    """At the instant t this time of a state has been reached."""
    return time <= t


def is_covered_step(t: int, ok: bool, mine: int, other: int) -> bool:
    """For the times compared so far (`ok`), the first state was ready whenever the other was; this also holds for
    this pair of times at the instant t. FOR ALL t.
    """
    return ok and not (ready(other, t) and not ready(mine, t))


def weighted(makespan: int, team: int, added: int, per_makespan: int, per_team: int) -> int:
    """The cost of a schedule: weighted latest end plus weighted sum of last ends, plus the cost of its legs."""
    return per_makespan * makespan + per_team * team + added


def leg_is_flown(leave: int, free: int, travel: int, start: int, end: int, duration: int) -> bool:
    """A vehicle that leaves at `leave`, not before it is free, arrives by the start of the task, which takes its full
    duration. THERE IS an instant `leave`.
    """
    return leave >= free and leave + travel <= start and end == start + duration


def row_is_raised(x: int, start: int, ref: int, lo: int) -> bool:
    """x satisfies the bounds so far and the row: not before `start`, nor before ref + lo. FOR ALL x: this equals `x
    >= m` exactly for m the raised start.
    """
    return x >= start and x >= ref + lo


class Flown(NamedTuple):
    """A chain so far: whether every leg is flown, and when the last task ends [ms]."""

    ok: bool
    free: int


def chain_step(chain: Flown, leave: int, travel: int, start: int, end: int, duration: int) -> Flown:
    """One more task: the vehicle leaves at `leave`. THERE IS such an instant for every task."""
    return Flown(chain.ok and leg_is_flown(leave, chain.free, travel, start, end, duration), end)


def chain_result(chain: Flown) -> bool:
    """After the last task: whether every leg was flown. Not quantified."""
    return chain.ok


def all_needed_done(k: int, done: int, need: int) -> bool:
    """If task number k is needed, it is done. FOR ALL k in 0..61: the task that needs them may be assigned."""
    return (need >> k) & 1 == 0 or (done >> k) & 1 == 1


def is_flown_in_laps(wait: int, laps: int, lap: int, lap_max: int, each: int, longer: int) -> bool:
    """The vehicle does not wait, or flies laps that together last as long as the wait: `longer` of them take `each` +
    1 ms, the others `each`, and it can fly all of them. THERE ARE such numbers.
    """
    if wait == 0:
        return True
    longest = each
    if longer > 0:
        longest = each + 1
    possible = each >= lap and longest <= lap_max
    return longer >= 0 and longer < laps and possible and each * laps + longer == wait
