"""Who flies which task, by which option, in which order: branch and bound with exact times.

Each node appends one task to the end of one vehicle's chain; times are integer ms and include
the waiting that order and timing need, across vehicles. Children are tried cheapest first, so the
first leaf is the greedy plan; every later leaf is better. A leaf is accepted only if the proved
kernels (`schedule_holds`, `eligible`) accept it. No clock: work is bounded by counted nodes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cratous.core.earliest import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
    Visit,
    earliest,
    next_wait_ms,
    reference_ms,
    rows_hold,
)
from cratous.core.kernel import driver
from cratous.core.timing import eligible, runs_forward
from cratous.spec.plan import Row

NODE_LIMIT = 50_000
START = -1
SETTLE_NODES = 20
"""What a schedule that needs the full iteration counts as, in nodes."""


class Candidate(NamedTuple):
    """One way to do one task. mask: bits of the vehicles that can fly it; times in ms."""

    task_id: int
    mask: int
    duration_ms: int
    lap_ms: int
    lap_max_ms: int


@dataclass(frozen=True)
class Branch:
    """One choice of `+`: its tasks, its rows, and which tasks may come next after some, in order."""

    tasks: tuple[int, ...]
    rows: tuple[Row, ...]
    allowed: Callable[[tuple[int, ...]], Iterable[int]]


class Fixed(NamedTuple):
    """A task that has already been flown: its times [ms]."""

    task_id: int
    start_ms: int
    end_ms: int


@dataclass(frozen=True)
class Problem:
    """What `assign` searches over.

    ready_ms: per vehicle (bit k is vehicle k), when it can set off; travel_ms(vehicle, from, to)
    gives the time from one candidate's end (or START) to another's start, or None if there is no
    way; eligible: mask of vehicles per task; cost: "MINMAX" (latest end), "CUMULATIVE" (sum of
    the vehicles' last ends) or "END:<task>" (the end of one task).
    """

    ready_ms: tuple[int, ...]
    candidates: tuple[Candidate, ...]
    travel_ms: Callable[[int, int, int], int | None]
    eligible: dict[int, int]
    branches: tuple[Branch, ...]
    cost: str = "MINMAX"
    fixed: tuple[Fixed, ...] = ()
    node_limit: int = NODE_LIMIT


class Placed(NamedTuple):
    """One task of the result: vehicle index, candidate index, times [ms]."""

    vehicle: int
    candidate: int
    depart_ms: int
    arrive_ms: int
    start_ms: int
    end_ms: int


@dataclass(frozen=True)
class Assignment:
    """The best leaf found: its branch and placements in order, or placed None.

    exhausted: every other leaf was visited or is no better by its bound.
    """

    branch: int
    placed: tuple[Placed, ...] | None
    cost: int
    nodes: int
    exhausted: bool


class _State(NamedTuple):
    """A partial assignment: per vehicle its last end and last candidate, and what is placed."""

    free_ms: tuple[int, ...]
    at: tuple[int, ...]
    placed: tuple[Placed, ...]
    starts: dict[int, int]
    ends: dict[int, int]


class _Search:
    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.nodes = 0
        self.best: tuple[int, int, tuple[Placed, ...]] | None = None
        self.stopped = False
        _, _, goal = problem.cost.partition("END:")
        self.goal = int(goal) if goal else None
        self.of_task: dict[int, list[int]] = {}
        for k, candidate in enumerate(problem.candidates):
            self.of_task.setdefault(candidate.task_id, []).append(k)
        self.least_in = self._least_in()

    def _least_in(self) -> dict[tuple[int, int], int]:
        """Per vehicle and candidate: the shortest way to it from anywhere, if there is one."""
        least: dict[tuple[int, int], int] = {}
        for v in range(len(self.problem.ready_ms)):
            for k, candidate in enumerate(self.problem.candidates):
                if not self.may(v, k):
                    continue
                ways = [self.problem.travel_ms(v, START, k)]
                ways += [
                    self.problem.travel_ms(v, j, k)
                    for j, other in enumerate(self.problem.candidates)
                    if other.task_id != candidate.task_id and self.may(v, j)
                ]
                known = [way for way in ways if way is not None]
                if known:
                    least[v, k] = min(known)
        return least

    def may(self, vehicle: int, k: int) -> bool:
        candidate = self.problem.candidates[k]
        return eligible(candidate.mask, 1 << vehicle) and eligible(
            self.problem.eligible.get(candidate.task_id, 0), 1 << vehicle
        )

    def cost(self, placed: Sequence[Placed]) -> int:
        """Cost of what is placed; it never falls when more is placed."""
        last: dict[int, int] = {}
        for p in placed:
            last[p.vehicle] = p.end_ms
            if self.goal == self.problem.candidates[p.candidate].task_id:
                return p.end_ms
        if self.goal is not None:
            return 0
        if self.problem.cost == "CUMULATIVE":
            return sum(last.values())
        return max(last.values(), default=0)

    def bound(self, state: _State, left: Sequence[int], due: dict[int, int]) -> int | None:
        """No completion costs less; None if some task left cannot be flown, or not when due."""
        least, work = self.cost(state.placed), 0
        for task in left:
            soonest = shortest = None
            for k in self.of_task.get(task, ()):
                for v in range(len(state.free_ms)):
                    way = self.least_in.get((v, k))
                    if way is None:
                        continue
                    effort = way + self.problem.candidates[k].duration_ms
                    end = state.free_ms[v] + effort
                    soonest = end if soonest is None or end < soonest else soonest
                    shortest = effort if shortest is None or effort < shortest else shortest
            if soonest is None or shortest is None or soonest > due.get(task, soonest):
                return None
            work += shortest
            if self.problem.cost == "MINMAX" or self.goal == task:
                least = max(least, soonest)
        if self.goal is not None:
            return least
        if self.problem.cost == "CUMULATIVE":
            return least + work
        return max(least, -(-(sum(state.free_ms) + work) // len(state.free_ms)))

    def place(self, state: _State, vehicle: int, k: int, rows: Sequence[Row]) -> _State | None:
        """Append candidate k to the vehicle's chain, as early as what is placed allows."""
        candidate = self.problem.candidates[k]
        travel = self.problem.travel_ms(vehicle, state.at[vehicle], k)
        if travel is None:
            return None
        depart = state.free_ms[vehicle]
        arrive = depart + travel
        start = arrive
        for row in rows:
            if row.i == candidate.task_id and row.kind in (AFTER_END, AFTER_START, NOT_BEFORE):
                reference = reference_ms(row, state.starts, state.ends)
                if reference is not None:
                    start = max(start, reference + row.lo)
        wait = next_wait_ms(start - arrive, candidate.lap_ms, candidate.lap_max_ms)
        start = arrive + wait if wait is not None else start
        end = start + candidate.duration_ms
        for row in rows:
            if row.i != candidate.task_id:
                continue
            if row.kind == NOT_AFTER and end > row.hi:
                return None
            if row.kind in (WITHIN_END, WITHIN_START) and self.too_far(
                state, vehicle, row, travel + candidate.duration_ms
            ):
                return None
        placed = Placed(vehicle, k, depart, arrive, start, end)
        return _State(
            (*state.free_ms[:vehicle], end, *state.free_ms[vehicle + 1 :]),
            (*state.at[:vehicle], k, *state.at[vehicle + 1 :]),
            (*state.placed, placed),
            {**state.starts, candidate.task_id: start},
            {**state.ends, candidate.task_id: end},
        )

    def too_far(self, state: _State, vehicle: int, row: Row, last_ms: int) -> bool:
        """True if the vehicle's own chain keeps the task from ending within the row's bound.

        Between a task that it flew and the end of the new one lies at least what it flies in
        between, however long anybody waits; last_ms: travel to the new task and its duration.
        """
        far: set[int] = set()
        between = last_ms
        for p in reversed([p for p in state.placed if p.vehicle == vehicle]):
            task, duration = self.problem.candidates[p.candidate].task_id, p.end_ms - p.start_ms
            if row.kind == WITHIN_START:
                between += duration
            if task in row.group and between > row.hi:
                far.add(task)
            if row.kind == WITHIN_END:
                between += duration
            between += p.arrive_ms - p.depart_ms
        return bool(far) and (row.kind == WITHIN_START or far == set(row.group))

    def leaf(self, state: _State, branch: int, rows: Sequence[Row]) -> None:
        """Accept a complete assignment if the kernels do and it is better than the best."""
        waits = [
            next_wait_ms(
                p.start_ms - p.arrive_ms,
                self.problem.candidates[p.candidate].lap_ms,
                self.problem.candidates[p.candidate].lap_max_ms,
            )
            == p.start_ms - p.arrive_ms
            for p in state.placed
        ]
        placed, starts, ends = state.placed, state.starts, state.ends
        if not all(waits) or not rows_hold(rows, starts, ends):
            self.nodes += SETTLE_NODES
            settled = settle(self.problem, placed, rows)
            if settled is None:
                return
            placed = settled
            starts, ends = times_of(self.problem, placed)
        if not rows_hold(rows, starts, ends) or not all(
            self.may(p.vehicle, p.candidate) and runs_forward(p.start_ms, p.end_ms) for p in placed
        ):
            return
        cost = self.cost(placed)
        if self.best is None or cost < self.best[0]:
            self.best = (cost, branch, placed)

    def run(self, branch_index: int) -> None:
        """Search one branch depth first."""
        problem, branch = self.problem, self.problem.branches[branch_index]
        fixed = sorted(problem.fixed, key=lambda f: (f.start_ms, f.end_ms, f.task_id))
        start = _State(
            problem.ready_ms,
            (START,) * len(problem.ready_ms),
            (),
            {f.task_id: f.start_ms for f in problem.fixed},
            {f.task_id: f.end_ms for f in problem.fixed},
        )
        seen: set[tuple[tuple[int, ...], ...]] = set()
        self._descend(start, tuple(f.task_id for f in fixed), branch_index, branch, seen)

    def _descend(
        self,
        state: _State,
        done: tuple[int, ...],
        branch_index: int,
        branch: Branch,
        seen: set[tuple[tuple[int, ...], ...]],
    ) -> None:
        left = [task for task in branch.tasks if task not in done]
        if not left:
            self.leaf(state, branch_index, branch.rows)
            return
        allowed = set(branch.allowed(done))
        due = {row.i: row.hi for row in branch.rows if row.kind == NOT_AFTER}
        children: list[tuple[int, int, int, int, int, _State]] = []
        for task in sorted(allowed & set(left)):
            after = [other for other in left if other != task]
            for k in self.of_task.get(task, ()):
                for vehicle in range(len(state.free_ms)):
                    if not self.may(vehicle, k):
                        continue
                    self.nodes += 1
                    child = self.place(state, vehicle, k, branch.rows)
                    if child is None:
                        continue
                    bound = self.bound(child, after, due)
                    if bound is None:
                        continue
                    end = child.placed[-1].end_ms
                    children.append((bound, end, task, vehicle, k, child))
        children.sort(key=lambda child: child[:5])
        for bound, _, task, _, _, child in children:
            if self.best is not None and bound >= self.best[0]:
                return
            # once over the limit, go on only to find a first leaf, and not for ever
            over = self.nodes - self.problem.node_limit
            patience = 4 * (self.problem.node_limit or NODE_LIMIT)
            if over > 0 and (self.best is not None or over > patience):
                self.stopped = True
                return
            chains = tuple(
                tuple(p.candidate for p in child.placed if p.vehicle == v)
                for v in range(len(child.at))
            )
            if chains in seen:
                continue
            seen.add(chains)
            self._descend(child, (*done, task), branch_index, branch, seen)
            if self.stopped:
                return


def times_of(problem: Problem, placed: Sequence[Placed]) -> tuple[dict[int, int], dict[int, int]]:
    """Starts and ends per task [ms], the fixed ones included."""
    starts = {f.task_id: f.start_ms for f in problem.fixed}
    ends = {f.task_id: f.end_ms for f in problem.fixed}
    for p in placed:
        task = problem.candidates[p.candidate].task_id
        starts[task], ends[task] = p.start_ms, p.end_ms
    return starts, ends


def settle(
    problem: Problem, placed: Sequence[Placed], rows: Sequence[Row]
) -> tuple[Placed, ...] | None:
    """The same chains with the earliest times under all rows, or None if there are none."""
    visits = [
        Visit(f.task_id, -1, 0, f.end_ms - f.start_ms, 0, 0, 0, f.start_ms) for f in problem.fixed
    ]
    last: dict[int, int] = {}
    at: dict[int, int] = {}
    for p in placed:
        candidate = problem.candidates[p.candidate]
        travel = problem.travel_ms(p.vehicle, at.get(p.vehicle, START), p.candidate)
        assert travel is not None
        visits.append(
            Visit(
                candidate.task_id,
                last.get(p.vehicle, -1),
                travel,
                candidate.duration_ms,
                candidate.lap_ms,
                candidate.lap_max_ms,
                problem.ready_ms[p.vehicle],
            )
        )
        last[p.vehicle], at[p.vehicle] = len(visits) - 1, p.candidate
    times = earliest(visits, rows)
    if times.violated is not None:
        return None
    shift = len(problem.fixed)
    return tuple(
        Placed(
            p.vehicle,
            p.candidate,
            times.arrive_ms[shift + i] - visits[shift + i].travel_ms,
            times.arrive_ms[shift + i],
            times.start_ms[shift + i],
            times.end_ms[shift + i],
        )
        for i, p in enumerate(placed)
    )


@driver(checked_by=("schedule_holds", "eligible"))
def assign(problem: Problem) -> Assignment:
    """The best assignment found within the node limit (at least one leaf is sought beyond it)."""
    search = _Search(problem)
    exhausted = True
    for k in range(len(problem.branches)):
        search.stopped = False
        search.run(k)
        exhausted = exhausted and not search.stopped
    if search.best is None:
        return Assignment(0, None, 0, search.nodes, exhausted)
    cost, branch, placed = search.best
    return Assignment(branch, placed, cost, search.nodes, exhausted)


def without_order(rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows under the weaker reading `order`: plain precedence binds no times."""
    return tuple(row for row in rows if not (row.kind in (AFTER_END, AFTER_START) and row.lo == 0))
