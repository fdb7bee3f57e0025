"""Solving an assignment problem: anytime, with a bound, and with what proves it.

Plain branches go to the compiled search; any other (time limits between tasks, laps) to the search
of `core.assignment`, whose leaves settle all times. A solution is returned only if the proved
checker accepts its schedule (`replayed`). `optimal` is said only of what `assign_certificate` can
show; that is done by `certified` there, so here a status is `feasible` until then.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from cratous.core.assignment_anytime import (
    NONE,
    Moves,
    Proof,
    estimate,
    greedy,
    improve,
    settle_bound,
    timed,
)
from cratous.core.assignment_instance import TASKS_MAX, Instance
from cratous.core.assignment_order import by_sets
from cratous.core.assignment_refute import DEALS_TASKS, look_ahead, refute
from cratous.services.planning import assign_general
from cratous.services.planning.assign_problem import Part, arrays, check, is_compiled, parts
from cratous.services.planning.assign_replay import replayed
from cratous.spec.assignment import ORDER, TIME, AssignmentProblem, Choice, Solution, Step

WORK = 16_000_000
"""Tasks that are decoded in one annealing: steps times tasks."""
ROUNDS, ROUNDS_MAX = 12, 10_000
"""Annealings of a problem of many tasks without and with a limit."""
DEALS_SURE = 16
"""Instances of so many tasks are refuted at once; larger ones from 90 % of the cost upwards."""

Progress = Callable[[int, int | None, int], None]
"""Told (nodes, incumbent's cost or None, bound) whenever one of them changes."""


@dataclass(frozen=True)
class Limits:
    """How far to search. seconds, nodes: None for no limit; nodes 0: the first leaf only; gap: stop
    once (cost - bound) / cost is at most this; width: states kept of a layer."""

    seconds: float | None = None
    nodes: int | None = None
    gap: float = 0.0
    width: int = 200_000
    seed: int = 1


@dataclass
class _Run:
    problem: AssignmentProblem
    limits: Limits
    progress: Progress | None
    began: float = field(default_factory=time.monotonic)
    nodes: int = 0
    states: int = 0
    cost: int = NONE
    bound: int = 0
    best: tuple[int, Moves] | None = None
    trace: list[tuple[int, int]] = field(default_factory=list)

    def over(self, more: int = 0, share: float = 1.0) -> bool:
        """Whether this share of the limits is used up."""
        limits, nodes = self.limits, self.nodes + more
        spent = time.monotonic() - self.began
        late = limits.seconds is not None and spent > share * limits.seconds
        return late or (limits.nodes is not None and nodes > share * limits.nodes)

    def better(self, cost: int, branch: int, moves: Moves) -> None:
        """Take a solution if it is the best so far."""
        if cost < self.cost:
            self.cost, self.best = cost, (branch, moves)
            self.trace.append((self.nodes, cost))
            self.tell()

    def tell(self) -> None:
        if self.progress is not None:
            self.progress(self.nodes, self.cost if self.best else None, self.bound)

    def near(self) -> bool:
        """Whether the gap is small enough."""
        return self.best is not None and self.cost - self.bound <= self.limits.gap * self.cost


def solve(
    problem: AssignmentProblem, limits: Limits | None = None, progress: Progress | None = None
) -> Solution:
    """The best assignment found within the limits, and the bound that was proved for it.

    Raises BadInput for a problem that means nothing. Without a solution the status is `infeasible`
    if that was proved, else `unknown`.
    """
    check(problem)
    warm()
    run = _Run(problem, limits or Limits(), progress)
    branches, all_of_them = parts(problem)
    if any(not is_compiled(problem, part) and not _large(part) for part in branches):
        return assign_general.solve(problem, branches, all_of_them, run.limits.nodes)
    made = [arrays(problem, part) for part in branches]
    firsts: list[Moves | None] = []
    for k, instance in enumerate(made):
        nodes, moves = greedy(instance)
        run.nodes += nodes
        firsts.append(moves)
        if moves is not None:
            run.better(improve(instance, moves, 0, run.limits.seed)[0], k, moves)
    if run.limits.nodes != 0:
        _anneal(run, made, firsts)
    proofs = _prove(run, made) if run.limits.nodes != 0 else [Proof("estimate", 0) for _ in made]
    run.bound = min((p.bound for p in proofs), default=0) if all_of_them else 0
    return _solution(run, branches, made, proofs)


@functools.cache
def warm() -> None:
    """Have everything compiled, so that no limit of time is spent on that."""
    far, near = (None, 1, 1), (1, None, 1)
    for semantics in (TIME, ORDER):
        p = AssignmentProblem(
            "", (1,), (0,), tuple(Choice(t, 1, 1, (1,)) for t in (1, 2, 3)),
            ((far, near, (1, 1, None), (1, 1, 1)),), ".(p1 p2 p3)", semantics=semantics,
        )  # fmt: skip
        i = arrays(p, parts(p)[0][0])
        _, moves = greedy(i)
        assert moves is not None
        improve(i, moves, 1, 1)
        refute(i, 7, 1)
        if semantics == ORDER:
            by_sets(i)
        estimate(i, look_ahead(i))


def _large(part: Part) -> bool:
    return part.plain


def _anneal(run: _Run, made: list[Instance], firsts: list[Moves | None]) -> None:
    """Improve the first leaves: short everywhere, longer for the best of few branches."""
    ends: list[tuple[int, int, Moves]] = []
    alive = [k for k, moves in enumerate(firsts) if moves is not None]
    for k in alive:
        moves = firsts[k]
        assert moves is not None
        n = made[k].tasks
        cost, better = _try(run, made[k], k, moves, min(2_000 * n, WORK // n // len(alive)), 0)
        ends.append((cost, k, better))
    ends.sort(key=lambda end: end[:2])
    for again in range(1, 4):
        for _, k, moves in ends[:2]:
            n = made[k].tasks
            if n > 10:
                _try(run, made[k], k, moves, WORK // n if n > 12 else 3_000 * n, again)
    _go_on(run, made)


def _go_on(run: _Run, made: list[Instance]) -> None:
    """Many tasks: improve the best again and again, cooler and warmer, until a limit is reached.

    Refuting takes over below that, so there only the share of time is spent that it leaves over.
    """
    rounds = 0
    while run.best is not None and made[run.best[0]].tasks > DEALS_TASKS and rounds < ROUNDS_MAX:
        k, moves = run.best
        spent = 1.0 if made[k].tasks > TASKS_MAX else 0.6
        if run.over(share=spent) or run.near():
            return
        unlimited = run.limits.seconds is None and run.limits.nodes is None
        if unlimited and rounds >= ROUNDS:
            return
        rounds += 1
        hot = (0.5, 0.2, 1.0)[rounds % 3] / made[k].tasks
        steps = (WORK << min(rounds // 3, 2)) // made[k].tasks
        _try(run, made[k], k, moves, steps, 3 + rounds, hot)


def _try(
    run: _Run, instance: Instance, k: int, moves: Moves, steps: int, again: int, hot: float = 0.15
) -> tuple[int, Moves]:
    """Anneal from a solution, within what is left of the node limit; steps count as nodes."""
    if run.limits.nodes is not None:
        steps = min(steps, max(0, run.limits.nodes - run.nodes))
    if run.over():
        steps = 0
    hot = min(hot, 2.0 / instance.tasks)
    cost, better = improve(instance, moves, steps, run.limits.seed + again, hot)
    run.nodes += steps
    run.better(cost, k, better)
    return cost, better


def _prove(run: _Run, made: list[Instance]) -> list[Proof]:
    """A proof of a bound for each branch; better solutions are taken on the way."""
    proofs = [Proof("estimate", estimate(instance)) for instance in made]
    most = max((i.tasks for i in made), default=0)
    for share in (0, 1000) if most <= DEALS_SURE else (900, 950, 980, 1000):
        for k, instance in enumerate(made):
            if proofs[k].bound >= run.cost or run.over():
                continue
            width = run.limits.width if share else min(run.limits.width, 3_000)
            limit = run.cost * share // 1000 if share else run.cost
            if limit <= proofs[k].bound:
                continue
            cost, moves, proof, search = settle_bound(instance, limit, width, run.over)
            if search is not None:
                run.nodes, run.states = run.nodes + search.nodes, run.states + search.states
            if moves is not None:
                run.better(cost, k, moves)
            if proof.bound > proofs[k].bound:
                proofs[k] = proof
        run.bound = min(min((p.bound for p in proofs), default=0), run.cost)
        run.tell()
        if run.near() or run.over():
            break
    return proofs


def _solution(
    run: _Run, branches: tuple[Part, ...], made: list[Instance], proofs: list[Proof]
) -> Solution:
    nodes, states, trace = run.nodes, run.states, tuple(run.trace)
    if run.best is None:
        status = "infeasible" if run.bound >= NONE else "unknown"
        return Solution(status, (), None, run.bound, nodes, states, trace, proof=proofs)
    k, moves = run.best
    steps = _steps(run.problem, branches[k], made[k], moves)
    cost = replayed(run.problem, steps)
    known = min(run.bound, cost)
    return Solution("feasible", steps, cost, known, nodes, states, trace, proof=proofs)


def _steps(
    problem: AssignmentProblem, part: Part, instance: Instance, moves: Moves
) -> tuple[Step, ...]:
    """The steps with their earliest times; by start, or as assigned where order binds no times."""
    found = []
    for v, o, arrive, start, end in timed(instance, moves):
        choice = problem.choices[part.choices[o]]
        found.append(
            Step(problem.vehicles[v], choice.task_id, choice.option_id, arrive, start, end)
        )
    return tuple(sorted(found, key=lambda s: (s.start_ms, s.end_ms)) if instance.waits else found)
