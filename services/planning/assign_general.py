"""Problems with time limits between tasks, or with laps: the search whose leaves settle all times.

Nothing that is late is dropped there for being covered, since with an upper limit between tasks
earlier is not always better. What the compiled search proves of the problem without those limits
(`relaxed`) is a bound here too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from cratous.core.assignment import (
    NODE_LIMIT,
    START,
    Branch,
    Candidate,
    Problem,
    assign,
)
from cratous.core.assignment_anytime import NONE, Proof, settle_bound
from cratous.core.assignment_instance import TASKS_MAX, is_plain
from cratous.services.planning.assign_problem import Part, arrays, has_lags
from cratous.services.planning.assign_replay import replayed, rows_in
from cratous.spec import algebra_runs
from cratous.spec.assignment import CUMULATIVE, MINMAX, ORDER, AssignmentProblem, Solution, Step
from cratous.spec.errors import BadInput

RELAXED_WIDTH = 20_000
ANY_WAIT_MS = 1 << 40


def solve(
    problem: AssignmentProblem, branches: Sequence[Part], all_of_them: bool, nodes: int | None
) -> Solution:
    """The best assignment found. BadInput for a cost that this search does not know."""
    if problem.cost not in (MINMAX, CUMULATIVE):
        raise BadInput(
            "with time limits between tasks or laps this cost is out of reach", item="cost",
            expected="MINMAX or CUMULATIVE alone", got=str(problem.cost),
        )  # fmt: skip
    bounds = [relaxed(problem, part) for part in branches]
    low = min((b.bound for b in bounds), default=0) if all_of_them else 0
    found = assign(_problem(problem, branches, nodes))
    if found.placed is None:
        proved = (found.exhausted or low >= NONE) and all_of_them
        status = "infeasible" if proved else "unknown"
        return Solution(status, (), None, low, found.nodes, 0, proof=bounds)
    steps = tuple(
        Step(
            problem.vehicles[p.vehicle], problem.choices[p.candidate].task_id,
            problem.choices[p.candidate].option_id, p.arrive_ms, p.start_ms, p.end_ms,
        )
        for p in found.placed
    )  # fmt: skip
    cost = replayed(problem, steps)
    exhausted = found.exhausted and all_of_them
    known = cost if exhausted else min(low, cost)
    return Solution(
        "feasible", steps, cost, known, found.nodes, 0, ((found.nodes, cost),), proof=bounds
    )  # fmt: skip


def relaxed(problem: AssignmentProblem, part: Part) -> Proof:
    """What is proved of a branch without upper limits between tasks, and with any wait."""
    rows = tuple(row for row in part.rows if is_plain((row,)))
    if problem.semantics == ORDER and has_lags(part):
        return Proof("estimate", 0)
    if len(part.tasks) > TASKS_MAX:
        return Proof("estimate", 0)
    instance = arrays(problem, replace(part, rows=rows, plain=True))
    cost, _, proof, _ = settle_bound(instance, NONE, RELAXED_WIDTH)
    return replace(proof, bound=min(proof.bound, cost)) if cost < NONE else proof


def _problem(problem: AssignmentProblem, branches: Sequence[Part], nodes: int | None) -> Problem:
    bit = {vehicle: 1 << v for v, vehicle in enumerate(problem.vehicles)}
    candidates = tuple(
        Candidate(
            c.task_id, sum(bit[v] for v in c.vehicles), c.duration_ms, c.lap_ms,
            ANY_WAIT_MS if c.lap_max_ms is None else c.lap_max_ms,
        )
        for c in problem.choices
    )  # fmt: skip
    everyone = sum(bit.values())

    def travel_ms(v: int, before: int, to: int) -> int | None:
        return problem.travel_ms[v][len(problem.choices) if before == START else before][to]

    made = []
    for part in branches:

        def allowed(before: tuple[int, ...], part: Part = part) -> Iterable[int]:
            return algebra_runs.next_actions(part.term, before)

        made.append(Branch(part.tasks, rows_in(problem, part), allowed))
    return Problem(
        ready_ms=problem.ready_ms,
        candidates=candidates,
        travel_ms=travel_ms,
        eligible=dict.fromkeys(problem.tasks, everyone),
        branches=tuple(made),
        cost="MINMAX" if problem.cost == MINMAX else "CUMULATIVE",
        node_limit=NODE_LIMIT if nodes is None else max(1, nodes),
    )
