"""The earliest schedule and the branch and bound, against definitions and brute force."""

import itertools
import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.assignment import START, Branch, Candidate, Fixed, Problem, assign, settle
from cratous.core.assignment import Placed as Place
from cratous.core.earliest import Visit, earliest, next_wait_ms, rows_hold
from cratous.spec.algebra import parallel_of, parse
from cratous.spec.algebra_meaning import branches, rows, tasks
from cratous.spec.algebra_runs import next_actions
from cratous.spec.plan import Row
from cratous.spec.schedule import (
    AFTER_END,
    AFTER_START,
    NOT_AFTER,
    NOT_BEFORE,
    WITHIN_END,
    WITHIN_START,
)


def visit(task, previous=-1, travel=100, duration=50, lap=40, widest=80, ready=0, fixed=None):
    return Visit(task, previous, travel, duration, lap, widest, ready, fixed)


def row(kind, i, group=(), lo=0, hi=0):
    return Row(kind, i, tuple(group), lo, hi, "")


@given(st.integers(-5, 500), st.integers(1, 50), st.integers(0, 50))
def test_a_wait_is_none_or_whole_laps(wait, lap, more):
    widest = lap + more
    got = next_wait_ms(wait, lap, widest)
    # by definition: none, or n laps of one possible length each
    possible = (0, *(w for n in range(1, 501) for w in (n * lap, n * widest)))
    whole = [n for n in range(1, 501) if n * lap <= got <= n * widest]
    assert got == 0 or whole
    assert got >= wait
    assert got in possible or got == wait
    assert not [w for w in possible if wait <= w < got]


def test_no_room_to_hold_means_no_wait():
    assert next_wait_ms(1, 40, 0) is None
    assert next_wait_ms(0, 40, 0) == 0


def test_a_successor_waits_at_least_one_lap():
    chains = [visit(1), visit(2, travel=130)]
    times = earliest(chains, [row(AFTER_END, 2, (1,))])
    # arrives at 130, might start at 150, but a lap takes 40
    assert (times.arrive_ms[1], times.start_ms[1], times.end_ms[1]) == (130, 170, 220)
    assert times.violated is None


def test_where_there_is_no_room_the_vehicle_waits_before():
    chains = [visit(1, travel=500), visit(2), visit(3, previous=1, travel=10, widest=0)]
    times = earliest(chains, [row(AFTER_END, 3, (1,))])
    assert times.violated is None
    assert times.start_ms[2] == times.arrive_ms[2] >= times.end_ms[0]
    assert times.start_ms[1] > times.arrive_ms[1]


def test_a_bound_on_the_end_raises_the_reference():
    # 2 may end at most 60 after 1 ends, but 2 arrives late: 1 has to wait
    chains = [visit(1, travel=10), visit(2, travel=1000)]
    within = row(WITHIN_END, 2, (1,), hi=60)
    times = earliest(chains, [row(AFTER_END, 2, (1,)), within])
    assert times.violated is None
    starts = dict(zip((1, 2), times.start_ms, strict=True))
    ends = dict(zip((1, 2), times.end_ms, strict=True))
    assert rows_hold([within], starts, ends)
    assert ends[2] <= ends[1] + 60


def test_a_group_is_tried_member_by_member():
    # the only member that can wait so long is 2; 1 must end early
    chains = [visit(1), visit(2), visit(3, travel=1000)]
    wanted = [row(WITHIN_END, 3, (1, 2), hi=10), row(NOT_AFTER, 1, hi=200)]
    times = earliest(chains, wanted)
    assert times.violated is None
    assert times.end_ms[0] <= 200
    assert times.end_ms[2] <= times.end_ms[1] + 10


def test_the_earliest_start_of_a_group_moves_them_all():
    chains = [visit(1), visit(2), visit(3, travel=1000)]
    times = earliest(chains, [row(WITHIN_START, 3, (1, 2), hi=100)])
    assert times.violated is None
    assert times.end_ms[2] <= min(times.start_ms[:2]) + 100


@pytest.mark.parametrize(
    "wanted",
    [
        [row(NOT_AFTER, 1, hi=100)],
        [row(AFTER_END, 1, (2,)), row(AFTER_END, 2, (1,))],
        [row(AFTER_START, 2, (1,), lo=100), row(WITHIN_START, 2, (1,), hi=120)],
        [row(NOT_BEFORE, 1, lo=500), row(NOT_AFTER, 1, hi=540)],
    ],
)
def test_what_cannot_be_is_said_with_the_row(wanted):
    times = earliest([visit(1), visit(2)], wanted)
    assert times.violated in wanted


def test_flown_tasks_keep_their_times():
    times = earliest([visit(1, fixed=700), visit(2, ready=100)], [row(AFTER_END, 2, (1,))])
    assert (times.start_ms[0], times.end_ms[0]) == (700, 750)
    assert times.start_ms[1] >= 750


ROWS = st.lists(
    st.builds(
        row,
        st.integers(1, 6),
        st.integers(1, 4),
        st.lists(st.integers(1, 4), min_size=1, max_size=2, unique=True),
        st.integers(0, 300),
        st.integers(100, 900),
    ),
    max_size=5,
)


@given(ROWS, st.lists(st.integers(0, 400), min_size=4, max_size=4))
def test_whatever_it_gives_holds(wanted, travels):
    chains = [
        visit(1, travel=travels[0]),
        visit(2, previous=0, travel=travels[1]),
        visit(3, travel=travels[2]),
        visit(4, previous=2, travel=travels[3], widest=0),
    ]
    times = earliest(chains, wanted)
    if times.violated is not None:
        return
    starts = dict(zip((1, 2, 3, 4), times.start_ms, strict=True))
    ends = dict(zip((1, 2, 3, 4), times.end_ms, strict=True))
    assert rows_hold(wanted, starts, ends)
    for k, one in enumerate(chains):
        leave = 0 if one.previous < 0 else times.end_ms[one.previous]
        assert times.arrive_ms[k] == leave + one.travel_ms
        wait = times.start_ms[k] - times.arrive_ms[k]
        assert wait == next_wait_ms(wait, one.lap_ms, one.lap_max_ms)


def problem(seed, text, count=4, vehicles=2, cost="MINMAX", limit=200_000):
    """A random problem: every task has two options with different eligible vehicles."""
    rng = random.Random(seed)
    term = parse(text, frozenset(range(1, count + 1))) if text else parallel_of(range(1, count + 1))
    made = []
    for task in range(1, count + 1):
        for _ in range(2):
            mask = rng.randrange(1, 2**vehicles)
            made.append(Candidate(task, mask, rng.randrange(10, 200), 60, 120))
    travel = {
        (v, j, k): rng.randrange(10, 400)
        for v in range(vehicles)
        for j in range(-1, len(made))
        for k in range(len(made))
    }
    masks = dict.fromkeys(range(1, count + 1), 2**vehicles - 1)
    listed = tuple(
        Branch(tasks(b), rows(b), lambda done, b=b: next_actions(b, done)) for b in branches(term)
    )
    return Problem(
        (0,) * vehicles,
        tuple(made),
        lambda v, j, k: travel[v, j, k],
        masks,
        listed,
        cost,
        node_limit=limit,
    )


def brute_force(given_problem):
    """The least cost over all orders, vehicles and options; None if there is none."""
    best = None
    for branch in given_problem.branches:
        for order in itertools.permutations(branch.tasks):
            if any(t not in branch.allowed(order[:k]) for k, t in enumerate(order)):
                continue
            choices = [
                [
                    (v, k)
                    for k, c in enumerate(given_problem.candidates)
                    for v in range(len(given_problem.ready_ms))
                    if c.task_id == task and c.mask >> v & 1
                ]
                for task in order
            ]
            for choice in itertools.product(*choices):
                placed = settle(
                    given_problem, [Place(v, k, 0, 0, 0, 0) for v, k in choice], branch.rows
                )
                if placed is None:
                    continue
                last = {p.vehicle: p.end_ms for p in placed}
                ends = last.values()
                cost = sum(ends) if given_problem.cost == "CUMULATIVE" else max(ends)
                best = cost if best is None else min(best, cost)
    return best


TEXTS = ["", ".(p1 p2 p3)", "~(p1 p2 p3)", "+(.(p1 p2) |(p2 p3))", "|(p1_[200-900] p2 p3)"]


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("cost", ["MINMAX", "CUMULATIVE"])
def test_the_optimum_is_that_of_brute_force(text, cost):
    for seed in range(4):
        given_problem = problem(seed, text, count=3, cost=cost)
        result = assign(given_problem)
        assert result.exhausted
        assert (result.cost if result.placed else None) == brute_force(given_problem)


@given(st.integers(0, 10_000), st.sampled_from(["", ".(p1 |(p2 p3) p4)", "~(p1 .(p2 p3) p4)"]))
@settings(max_examples=30, deadline=None)
def test_what_is_assigned_holds_and_is_flyable(seed, text):
    given_problem = problem(seed, text, limit=500)
    result = assign(given_problem)
    assert result.placed is not None
    branch = given_problem.branches[result.branch]
    starts, ends = {}, {}
    free, at = [0, 0], [START, START]
    for p in sorted(result.placed, key=lambda p: p.depart_ms):
        candidate = given_problem.candidates[p.candidate]
        assert candidate.mask >> p.vehicle & 1
        assert p.depart_ms == free[p.vehicle]
        travel = given_problem.travel_ms(p.vehicle, at[p.vehicle], p.candidate)
        assert p.arrive_ms == p.depart_ms + travel
        assert p.end_ms - p.start_ms == candidate.duration_ms
        free[p.vehicle], at[p.vehicle] = p.end_ms, p.candidate
        starts[candidate.task_id], ends[candidate.task_id] = p.start_ms, p.end_ms
    assert sorted(starts) == sorted(branch.tasks)
    assert rows_hold(branch.rows, starts, ends)
    assert assign(given_problem) == result


def test_an_ineligible_vehicle_gets_nothing():
    given_problem = problem(1, "", count=2)
    only_second = Problem(
        given_problem.ready_ms,
        given_problem.candidates,
        given_problem.travel_ms,
        {1: 0b10, 2: 0b10},
        given_problem.branches,
    )
    result = assign(only_second)
    assert result.placed is None or {p.vehicle for p in result.placed} == {1}


def test_flown_tasks_bind_those_to_come():
    given_problem = problem(3, ".(p1 p2 p3 p4)")
    done = (Fixed(1, 100, 5000),)
    result = assign(
        Problem(
            (900, 900),
            given_problem.candidates,
            given_problem.travel_ms,
            given_problem.eligible,
            given_problem.branches,
            fixed=done,
        )
    )
    assert {given_problem.candidates[p.candidate].task_id for p in result.placed} == {2, 3, 4}
    assert min(p.start_ms for p in result.placed) >= 5000
    assert min(p.depart_ms for p in result.placed) == 900
