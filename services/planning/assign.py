"""Assignment search: anytime, with a proved bound and the evidence for it.

The arrays of a branch go to the compiled search. Where they do not express all constraints (upper limits
between tasks, laps), a `Settler` computes the times of each solution, bounds of the arrays still hold, and
the remaining gap is closed by enumerating chains (`core.assignment.chains`). A solution is returned only if
the proved checker accepts its schedule (`replayed`). Only `certified` in `assign_certificate` may declare a
solution `optimal`; here its status is `feasible`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from cratous.core.assignment.anytime import (
    NONE,
    Moves,
    Proof,
    estimate,
    greedy,
    improve,
    rebuilt,
    settle_bound,
    timed,
)
from cratous.core.assignment.chains import chains_below
from cratous.core.assignment.compiled import is_moderate
from cratous.core.assignment.instance import TASKS_MAX, Instance
from cratous.core.assignment.layers import DEALS_TASKS
from cratous.core.assignment.optimality import shows_optimal
from cratous.core.assignment.repair import repaired
from cratous.core.assignment.settlement import Settler
from cratous.services.planning import pending_compilation
from cratous.services.planning.assign_problem import (
    Part,
    arrays,
    check,
    is_exact,
    parts,
    settler,
)
from cratous.services.planning.assign_replay import replayed
from cratous.services.planning.assign_warm import warm
from cratous.spec.assignment.search import AssignmentProblem, Solution, Step

WORK = 16_000_000
"""Task decodings per annealing run: steps times tasks."""
ROUNDS, ROUNDS_MAX = 12, 10_000
"""Improvement rounds of a problem with many tasks, without and with a limit."""
STEPS_A_NODE = 8
"""Annealing steps that count as one node of the exact search."""
REBUILDS, REBUILD_NODES, HEATS = 150_000, 40, (0.0, 0.01, 0.003, 0.03)
"""Rounds times tasks of one improvement, nodes that a round counts as, and initial temperatures."""
REPAIRS = 60
"""Neighbourhoods of an incumbent reassigned by the exact search."""
FEW_BRANCHES, NARROW = 4, 64
"""With at most this many branches, a search of this width first tries to show optimality."""
FIRST_NODES = 200_000
"""Nodes spent on finding a first solution if the limit is lower."""
CHAIN_NODES = 5_000_000
"""Nodes spent on enumerating chains without a limit."""
DEALS_SURE = 16
"""Instances with up to this many tasks are refuted directly; larger ones from 90 % of the cost upwards."""

Progress = Callable[[int, int | None, int], None]
"""Called with (nodes, incumbent's cost or None, bound) whenever one of them changes."""


@dataclass(frozen=True)
class Limits:
    """Search limits. seconds, nodes: None for no limit, 0 nodes for the first leaf only; gap: stop once (cost
    - bound) / cost is at most this; width: states kept per layer.
    """

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
    branches: tuple[Part, ...]
    made: list[Instance]
    settlers: list[Settler | None]
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
        """Accept a solution if it is the best so far. cost: according to the arrays."""
        if cost >= self.cost:
            return
        rules = self.settlers[branch]
        if rules is not None:
            cost, times = rules.settle(moves, self.cost)
            if times is None:
                return
        self.cost, self.best = cost, (branch, moves)
        self.trace.append((self.nodes, cost))
        self.tell()

    def late(self, nodes: int) -> bool:
        """Whether the time limit has passed."""
        return time.monotonic() - self.began > (self.limits.seconds or 0.0)

    def tell(self) -> None:
        if self.progress is not None:
            self.progress(self.nodes, self.cost if self.best else None, self.bound)

    def near(self) -> bool:
        """Whether the gap is small enough."""
        return self.best is not None and self.cost - self.bound <= self.limits.gap * self.cost


def solve(
    problem: AssignmentProblem, limits: Limits | None = None, progress: Progress | None = None
) -> Solution:
    """The best assignment found within the limits, and its proved bound.

    Raises BadInput for an invalid problem. Without a solution the status is `infeasible` if that was proved,
    else `unknown`.
    """
    check(problem)
    run, proofs = _searched(problem, limits or Limits(), *parts(problem), progress)
    return _solution(run, proofs, True)


def search(
    problem: AssignmentProblem, limits: Limits, branches: Sequence[Part], complete: bool
) -> Solution:
    """`solve` for the given branches instead of the problem's own; the schedule is not replayed."""
    return _solution(*_searched(problem, limits, tuple(branches), complete, None), False)


def _searched(
    problem: AssignmentProblem, limits: Limits, branches: tuple[Part, ...], complete: bool,
    progress: Progress | None,
) -> tuple[_Run, list[Proof]]:  # fmt: skip
    made = [arrays(problem, part) for part in branches]
    if not all(map(is_moderate, made)):
        pending_compilation.ready(pending_compilation.ASSIGNMENT)
    if limits.seconds is not None:
        warm()
    rules = [
        None if is_exact(problem, part) else settler(problem, part, instance)
        for part, instance in zip(branches, made, strict=True)
    ]
    run = _Run(problem, limits, progress, branches, made, rules)
    firsts: list[Moves | None] = []
    for k, instance in enumerate(made):
        nodes, moves = greedy(instance)
        run.nodes += nodes
        firsts.append(moves)
        if moves is not None:
            run.better(improve(instance, moves, 0, run.limits.seed)[0], k, moves)
    proofs = [Proof("estimate", estimate(instance)) for instance in made]
    run.bound = min((p.bound for p in proofs), default=0)
    # a first leaf at the bound cannot be improved
    if run.limits.nodes != 0 and not run.near():
        _anneal(run, made, firsts)
        _prove(run, made, proofs)
    _list_chains(run, proofs)
    if not complete:  # nothing is proved about branches not examined
        run.bound, proofs = 0, []
    else:
        run.bound = min((p.bound for p in proofs), default=NONE)
    return run, proofs


def _list_chains(run: _Run, proofs: list[Proof]) -> None:
    """Close the gap between bound and cost where the arrays do not express all of a branch.

    Without a solution so far, one is sought beyond the node limit, up to a maximum.
    """
    open_ones = [
        k for k, rules in enumerate(run.settlers)
        if rules is not None and rules.ahead is not None and proofs[k].bound < run.cost
    ]  # fmt: skip
    for k in sorted(open_ones, key=lambda k: proofs[k].bound):
        rules, most = run.settlers[k], run.limits.nodes
        left = CHAIN_NODES if most is None else max(0, most - run.nodes)
        if run.best is None:
            left = max(left, FIRST_NODES)
        elif run.near() or run.over():
            return
        assert rules is not None
        doubts = rules.unsure
        late = None if run.limits.seconds is None else run.late
        found = chains_below(run.made[k], run.cost, rules.judge, left, late, rules.ahead)
        run.nodes += found.nodes
        if found.moves is not None:
            run.better(found.cost, k, found.moves)
        if found.complete and rules.unsure == doubts:
            proofs[k] = Proof("chains", max(found.cost, proofs[k].bound), found.nodes)


def _anneal(run: _Run, made: list[Instance], firsts: list[Moves | None]) -> None:
    """Improve the first leaves: briefly for all, longer for the best of a few branches."""
    ends: list[tuple[int, int, Moves]] = []
    alive = [k for k, moves in enumerate(firsts) if moves is not None]
    for k in alive:
        moves = firsts[k]
        assert moves is not None
        n = made[k].tasks
        cost, better = _try(run, made[k], k, moves, min(2_000 * n, WORK // n // len(alive)), 0)
        ends.append((cost, k, better))
    if _is_settled(run, made):
        return
    ends.sort(key=lambda end: end[:2])
    for again in range(1, 4):
        for _, k, moves in ends[:2]:
            n = made[k].tasks
            if n > 10:
                _try(run, made[k], k, moves, WORK // n if n > 16 else 3_000 * n, again)
    _go_on(run, made)


def _is_settled(run: _Run, made: list[Instance]) -> bool:
    """Whether a narrow search of a large problem finds the optimum of a few branches and proves it, e.g.
    where the order is fixed, so that no improvement is needed. Its solution is accepted only in that case.
    """
    if run.best is None or len(made) > FEW_BRANCHES or made[run.best[0]].tasks <= DEALS_TASKS:
        return False
    found = [settle_bound(instance, run.cost, NARROW, run.over) for instance in made]
    low = min(proof.bound for _, _, proof, _ in found)
    if not shows_optimal(min(cost for cost, *_ in found), low):
        return False
    for k, (cost, moves, *_) in enumerate(found):
        if moves is not None:
            run.better(cost, k, moves)
    return shows_optimal(run.cost, low)


def _go_on(run: _Run, made: list[Instance]) -> None:
    """For many tasks: remove strings of tasks from the best solution and reinsert them, alternating with
    annealing at varying temperatures, until a limit is reached.

    Below TASKS_MAX the refutation follows, so only a share of the time is spent here.
    """
    rounds, gains = 0, [1, 1]
    while run.best is not None and made[run.best[0]].tasks > DEALS_TASKS and rounds < ROUNDS_MAX:
        k, moves = run.best
        spent = 1.0 if made[k].tasks > TASKS_MAX else 0.6
        if run.over(share=spent) or run.near():
            return
        unlimited = run.limits.seconds is None and run.limits.nodes is None
        if unlimited and rounds >= ROUNDS:
            return
        rounds += 1
        # the method with the larger recent gain; the other one every third round
        anneals, before = (gains[1] > gains[0]) != (rounds % 3 == 0), run.cost
        if anneals:
            hot = (0.5, 0.2, 1.0)[rounds % 3] / made[k].tasks
            steps = (WORK << min(rounds // 3, 2)) // made[k].tasks
            _try(run, made[k], k, moves, steps, 3 + rounds, hot)
        else:
            _rebuild(run, made[k], k, moves, rounds)
        gains[anneals] = before - run.cost
        if gains[anneals] > 0 or rounds == 1:
            _repair(run, made[run.best[0]], rounds)


def _repair(run: _Run, instance: Instance, again: int) -> None:
    """Reassign windows of a new incumbent's chains with the exact search."""
    assert run.best is not None
    k, moves = run.best
    cost, better, nodes = repaired(instance, moves, REPAIRS, run.limits.seed + again, run.over)
    run.nodes += nodes
    run.better(cost, k, better)


def _rebuild(run: _Run, instance: Instance, k: int, moves: Moves, again: int) -> None:
    """Rounds of removal and reinsertion, within the remaining node limit."""
    rounds = REBUILDS // instance.tasks
    if run.limits.nodes is not None:
        rounds = min(rounds, max(0, run.limits.nodes - run.nodes) // REBUILD_NODES)
    cost, better = rebuilt(instance, moves, rounds, run.limits.seed + again, HEATS[again % 4])
    run.nodes += max(1, rounds) * REBUILD_NODES
    run.better(cost, k, better)


def _try(
    run: _Run, instance: Instance, k: int, moves: Moves, steps: int, again: int, hot: float = 0.15
) -> tuple[int, Moves]:
    """Anneal from a solution, within the remaining node limit."""
    if run.limits.nodes is not None:
        # for up to this many tasks the refutation gets the larger share
        share = 0.3 if instance.tasks <= DEALS_TASKS else 1.0
        left = max(0, int(share * run.limits.nodes) - run.nodes)
        steps = min(steps, STEPS_A_NODE * left)
    if run.over():
        steps = 0
    hot = min(hot, 2.0 / instance.tasks)
    cost, better = improve(instance, moves, steps, run.limits.seed + again, hot)
    run.nodes += -(-steps // STEPS_A_NODE)
    run.better(cost, k, better)
    return cost, better


def _prove(run: _Run, made: list[Instance], proofs: list[Proof]) -> None:
    """Improve the bound of each branch; better solutions found on the way are accepted."""
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


def _solution(run: _Run, proofs: list[Proof], replay: bool) -> Solution:
    nodes, states, trace = run.nodes, run.states, tuple(run.trace)
    if run.best is None:
        status = "infeasible" if run.bound >= NONE else "unknown"
        return Solution(status, (), None, run.bound, nodes, states, trace, proof=proofs)
    steps = _steps(run, *run.best)
    cost = replayed(run.problem, steps) if replay else run.cost
    known = min(run.bound, cost)
    return Solution("feasible", steps, cost, known, nodes, states, trace, proof=proofs)


def _steps(run: _Run, k: int, moves: Moves) -> tuple[Step, ...]:
    """The steps with their best times, sorted by start, or as assigned where order does not bind times."""
    problem, part, instance, rules = run.problem, run.branches[k], run.made[k], run.settlers[k]
    times = timed(instance, moves) if rules is None else rules.settle(moves, NONE)[1]
    found = []
    for v, o, arrive, start, end in times or ():
        choice = problem.choices[part.choices[o]]
        found.append(
            Step(problem.vehicles[v], choice.task_id, choice.option_id, arrive, start, end)
        )
    return tuple(sorted(found, key=lambda s: (s.start_ms, s.end_ms)) if instance.waits else found)
