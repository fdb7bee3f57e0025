"""Random terms with timing against a brute force that is written from the meaning of the terms."""

from __future__ import annotations

import random
from itertools import permutations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_replay import replayed
from cratous.spec import algebra
from cratous.spec.algebra import meaning as algebra_meaning
from cratous.spec.algebra import runs as algebra_runs
from cratous.spec.assignment.search import ORDER, TIME, AssignmentProblem, Choice, Cost
from cratous.spec.errors import BadInput

HORIZON = 24
"""Beyond this no small problem starts anything: windows end at 19, and all together take less."""


def term(rng: random.Random, tasks: list[int], timed: bool, depth: int = 0) -> str:
    """A random text over these tasks, each once."""
    if len(tasks) == 1 and (depth or rng.random() < 0.3):
        return f"p{tasks[0]}" + suffix(rng, timed)
    parts: list[list[int]] = []
    for task in tasks:
        if parts and (rng.random() < 0.4 or len(parts) > 2):
            rng.choice(parts).append(task)
        else:
            parts.append([task])
    if len(parts) == 1 and len(tasks) > 1:
        parts = [[task] for task in tasks]
    op = rng.choice(".~|+.|~" if depth < 3 else ".|")
    inner = " ".join(term(rng, part, timed, depth + 1) for part in parts)
    return f"{op}({inner})" + suffix(rng, timed)


def suffix(rng: random.Random, timed: bool) -> str:
    """A timing, or none."""
    if not timed or rng.random() < 0.6:
        return ""
    t1 = rng.choice([0, 0, rng.randrange(6)])
    return f"{rng.choice('_-')}[{t1}-{t1 + rng.randrange(1, 14)}]"


def problem(
    seed: int, timed: bool = True, semantics: str = TIME, most: int = 4, laps: bool = False
) -> AssignmentProblem:
    """A problem of 1 to `most` tasks and 1 to 3 vehicles, with small numbers."""
    rng = random.Random(seed)
    turns = random.Random(seed + 1)
    tasks = list(range(1, rng.randrange(1, most + 1) + 1))
    rng.shuffle(tasks)
    vehicles = tuple(range(7, 7 + rng.choice([1, 2, 2, 3])))
    choices = []
    for task in tasks:
        for option in range(1, 2 + (rng.random() < 0.25)):
            able = tuple(v for v in vehicles if rng.random() < 0.75) or (rng.choice(vehicles),)
            lap = turns.randrange(1, 4) if laps else 0
            longest = turns.choice([0, lap, lap + 1, 2 * lap]) if laps else None
            choices.append(Choice(task, option, rng.randrange(0, 4), able, lap, longest))
    size = len(choices)

    def low(row: int) -> int:
        # a task without duration and a way without length after it are refused together
        return int(row < size and choices[row].duration_ms == 0)

    travel = tuple(
        tuple(
            tuple(None if rng.random() < 0.05 else rng.randrange(low(row), 5) for _ in range(size))
            for row in range(size + 1)
        )
        for _ in vehicles
    )
    ready = tuple(rng.choice([0, 0, rng.randrange(4)]) for _ in vehicles)
    due = tuple((t, rng.randrange(4, 16)) for t in tasks if timed and rng.random() < 0.15)
    release = tuple((t, rng.randrange(0, 6)) for t in tasks if timed and rng.random() < 0.15)
    cost = rng.choice([Cost(1, 0), Cost(1, 0), Cost(0, 1)])
    return AssignmentProblem(
        f"seed {seed}", vehicles, ready, tuple(choices), travel, term(rng, tasks, timed),
        release, due, cost, semantics,
    )  # fmt: skip


def least_below(p: AssignmentProblem, limit: int) -> int | None:
    """The least cost below `limit`, by trying all chains and all times; None: there is none."""
    meant = algebra.parse(p.relations)
    best: int | None = None
    sets = {frozenset(algebra_meaning.tasks(b)) for b in algebra_meaning.branches(meant)}
    for chosen in sets:
        for who in product(range(len(p.vehicles)), repeat=len(chosen)):
            for order in permutations(sorted(chosen)):
                dealt = dict(zip(sorted(chosen), who, strict=True))
                chains = [[t for t in order if dealt[t] == v] for v in range(len(p.vehicles))]
                # one order stands for all that give the same chains
                if [t for chain in chains for t in chain] != list(order):
                    continue
                cost = _chains(p, meant, chains, limit if best is None else min(limit, best))
                if cost is not None:
                    best = cost
    return best


def _chains(
    p: AssignmentProblem, meant: algebra.Term, chains: list[list[int]], limit: int
) -> int | None:
    """The least cost below the limit of these chains, over all options and times."""
    best: int | None = None
    tasks = [t for chain in chains for t in chain]
    options = [
        [k for k, c in enumerate(p.choices) if c.task_id == t] for t in tasks
    ]  # fmt: skip
    for picked in product(*options):
        how = dict(zip(tasks, picked, strict=True))
        good = all(
            p.vehicles[v] in p.choices[how[t]].vehicles for v, c in enumerate(chains) for t in c
        )
        if not good:
            continue
        if p.semantics == ORDER and not _orders(meant, chains):
            continue
        found = _times(p, meant, chains, how, limit if best is None else best)
        best = found if found is not None else best
    return best


def _orders(meant: algebra.Term, chains: list[list[int]]) -> bool:
    """Whether some order of all tasks keeps to the chains and is one of assignment."""
    tasks = [t for chain in chains for t in chain]
    return any(
        all([t for t in order if t in chain] == chain for chain in chains)
        and algebra_runs.complete(meant, order)
        for order in permutations(tasks)
    )


def _times(
    p: AssignmentProblem, meant: algebra.Term, chains: list[list[int]], how: dict[int, int],
    limit: int,
) -> int | None:  # fmt: skip
    """The least cost below the limit, over all starts (or the one start without waiting)."""
    line = [(v, i, t) for v, chain in enumerate(chains) for i, t in enumerate(chain)]
    best: list[int | None] = [None]
    times: dict[int, tuple[int, int]] = {}
    release, due = dict(p.release_ms), dict(p.due_ms)

    def cost() -> int:
        ends = [times[c[-1]][1] for c in chains if c]
        return p.cost.makespan * max(ends) + p.cost.team * sum(ends)

    def go(at: int) -> None:
        bound = limit if best[0] is None else best[0]
        if at == len(line):
            value = cost()
            fits = p.semantics == ORDER or algebra_meaning.satisfied(meant, times)
            if value < bound and fits:
                best[0] = value
            return
        v, i, t = line[at]
        k = how[t]
        way = p.travel_ms[v][len(p.choices) if i == 0 else how[chains[v][i - 1]]][k]
        if way is None:
            return
        free = p.ready_ms[v] if i == 0 else times[chains[v][i - 1]][1]
        first = max(free + way, release.get(t, 0))
        last = bound - p.choices[k].duration_ms
        for start in (first,) if p.semantics == ORDER else range(first, last + 1):
            if not can_wait(p.choices[k], start - free - way):
                continue
            end = start + p.choices[k].duration_ms
            if end > due.get(t, end):
                break
            times[t] = (start, end)
            go(at + 1)
            del times[t]

    go(0)
    return best[0]


def can_wait(choice: Choice, wait: int) -> bool:
    """Whether some number of equal laps, or none, takes so long."""
    if wait == 0 or choice.lap_max_ms is None:
        return True
    most = choice.lap_max_ms
    return any(n * choice.lap_ms <= wait <= n * most for n in range(1, wait + 1))


def differs(p: AssignmentProblem) -> str:
    """What is wrong with the answer to a problem; nothing if it is right."""
    try:
        found = solve(p, Limits(nodes=200_000))
    except BadInput as error:
        return "" if "eligible" in str(error) else str(error)
    if found.cost is None:
        if found.status != "infeasible":
            return f"{p.name}: {found.status}"
        truth = least_below(p, HORIZON)
        return "" if truth is None else f"{p.name}: {truth} exists, said infeasible"
    if replayed(p, found.steps) != found.cost:
        return f"{p.name}: the cost is another"
    if found.bound > found.cost:
        return f"{p.name}: the bound {found.bound} is above the cost {found.cost}"
    truth = least_below(p, found.cost)
    return "" if truth is None else f"{p.name}: {truth} exists, {found.cost} said"


@settings(max_examples=150)
@given(st.integers(0, 2**32))
def test_terms_with_timing_are_solved_to_the_optimum(seed: int) -> None:
    assert differs(problem(seed, most=3)) == ""


@settings(max_examples=60)
@given(st.integers(0, 2**32))
def test_waits_of_whole_laps_are_solved_to_the_optimum(seed: int) -> None:
    assert differs(problem(seed, most=3, laps=True)) == ""


@settings(max_examples=100)
@given(st.integers(0, 2**32))
def test_order_only_is_solved_to_the_optimum(seed: int) -> None:
    assert differs(problem(seed, timed=False, semantics=ORDER)) == ""


@pytest.mark.long
@pytest.mark.parametrize("part", range(20))
def test_thousands_of_terms(part: int) -> None:
    wrong = []
    for k in range(500):
        seed = 1_000_000 + 500 * part + k
        timed = k % 4 != 0
        case = problem(seed, timed, ORDER if k % 8 == 0 else TIME, 3 if timed else 4, k % 3 == 1)
        wrong.append(differs(case))
    assert [w for w in wrong if w] == []
