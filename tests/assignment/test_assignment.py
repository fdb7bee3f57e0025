"""The earliest schedule of chains, and assignments with laps, limits and tasks that are flown."""

import random
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.assignment import compiled as assignment_compiled
from cratous.core.assignment import layers
from cratous.core.assignment.earliest_times import (
    Times,
    Unmet,
    Visit,
    earliest,
    next_wait_ms,
    rows_hold,
)
from cratous.core.readings import tiered
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_certificate import certified, verify
from cratous.services.planning.assign_replay import replayed
from cratous.services.planning.assign_solvers import none_below, why_infeasible
from cratous.spec import constraint_rows
from cratous.spec.assignment.search import ORDER, TIME, AssignmentProblem, Choice
from cratous.spec.errors import BadInput


def visit(task, previous=-1, travel=100, duration=50, lap=40, widest=80, ready=0, fixed=None):
    return Visit(task, previous, travel, duration, lap, widest, ready, fixed)


def row(kind, i, group=(), lo=0, hi=0):
    return constraint_rows.Row(kind, i, tuple(group), lo, hi, "")


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
    times = earliest(chains, [row(constraint_rows.AFTER_END, 2, (1,))])
    # arrives at 130, might start at 150, but a lap takes 40
    assert (times.arrive_ms[1], times.start_ms[1], times.end_ms[1]) == (130, 170, 220)
    assert isinstance(times, Times)


def test_where_there_is_no_room_the_vehicle_waits_before():
    chains = [visit(1, travel=500), visit(2), visit(3, previous=1, travel=10, widest=0)]
    times = earliest(chains, [row(constraint_rows.AFTER_END, 3, (1,))])
    assert isinstance(times, Times)
    assert times.start_ms[2] == times.arrive_ms[2] >= times.end_ms[0]
    assert times.start_ms[1] > times.arrive_ms[1]


def test_a_bound_on_the_end_raises_the_reference():
    # 2 may end at most 60 after 1 ends, but 2 arrives late: 1 has to wait
    chains = [visit(1, travel=10), visit(2, travel=1000)]
    within = row(constraint_rows.WITHIN_END, 2, (1,), hi=60)
    times = earliest(chains, [row(constraint_rows.AFTER_END, 2, (1,)), within])
    assert isinstance(times, Times)
    starts = dict(zip((1, 2), times.start_ms, strict=True))
    ends = dict(zip((1, 2), times.end_ms, strict=True))
    assert rows_hold([within], starts, ends)
    assert ends[2] <= ends[1] + 60


def test_a_group_is_tried_member_by_member():
    # the only member that can wait so long is 2; 1 must end early
    chains = [visit(1), visit(2), visit(3, travel=1000)]
    wanted = [
        row(constraint_rows.WITHIN_END, 3, (1, 2), hi=10),
        row(constraint_rows.NOT_AFTER, 1, hi=200),
    ]
    times = earliest(chains, wanted)
    assert isinstance(times, Times)
    assert times.end_ms[0] <= 200
    assert times.end_ms[2] <= times.end_ms[1] + 10


def test_the_earliest_start_of_a_group_moves_them_all():
    chains = [visit(1), visit(2), visit(3, travel=1000)]
    times = earliest(chains, [row(constraint_rows.WITHIN_START, 3, (1, 2), hi=100)])
    assert isinstance(times, Times)
    assert times.end_ms[2] <= min(times.start_ms[:2]) + 100


@pytest.mark.parametrize(
    "wanted",
    [
        [row(constraint_rows.NOT_AFTER, 1, hi=100)],
        [row(constraint_rows.AFTER_END, 1, (2,)), row(constraint_rows.AFTER_END, 2, (1,))],
        [
            row(constraint_rows.AFTER_START, 2, (1,), lo=100),
            row(constraint_rows.WITHIN_START, 2, (1,), hi=120),
        ],
        [row(constraint_rows.NOT_BEFORE, 1, lo=500), row(constraint_rows.NOT_AFTER, 1, hi=540)],
    ],
)
def test_what_cannot_be_is_said_with_the_row(wanted):
    times = earliest([visit(1), visit(2)], wanted)
    assert times.violated in wanted


def test_flown_tasks_keep_their_times():
    times = earliest(
        [visit(1, fixed=700), visit(2, ready=100)], [row(constraint_rows.AFTER_END, 2, (1,))]
    )
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
    if isinstance(times, Unmet):
        return
    starts = dict(zip((1, 2, 3, 4), times.start_ms, strict=True))
    ends = dict(zip((1, 2, 3, 4), times.end_ms, strict=True))
    assert rows_hold(wanted, starts, ends)
    for k, one in enumerate(chains):
        leave = 0 if one.previous < 0 else times.end_ms[one.previous]
        assert times.arrive_ms[k] == leave + one.travel_ms
        wait = times.start_ms[k] - times.arrive_ms[k]
        assert wait == next_wait_ms(wait, one.lap_ms, one.lap_max_ms)


def problem(seed, text, count=4, vehicles=2, **more):
    """A random problem with laps: every task has two options with different eligible vehicles."""
    rng = random.Random(seed)
    ids = tuple(range(11, 11 + vehicles))
    choices = []
    for task in range(1, count + 1):
        for option in (1, 2):
            mask = rng.randrange(1, 2**vehicles)
            able = tuple(v for k, v in enumerate(ids) if mask >> k & 1)
            choices.append(Choice(task, option, rng.randrange(10, 200), able, 60, 120))
    size = len(choices)
    travel = tuple(
        tuple(tuple(rng.randrange(10, 400) for _ in range(size)) for _ in range(size + 1))
        for _ in ids
    )
    made = AssignmentProblem("random", ids, (0,) * vehicles, tuple(choices), travel, text)
    return replace(made, **more)


@given(st.integers(0, 10_000), st.sampled_from(["", ".(p1 |(p2 p3) p4)", "~(p1 .(p2 p3) p4)"]))
@settings(max_examples=20, deadline=None)
def test_what_is_assigned_holds_and_is_flyable(seed, text):
    of = problem(seed, text)
    result = solve(of, Limits(nodes=500))
    assert replayed(of, result.steps) == result.cost
    free, at = dict.fromkeys(of.vehicles, 0), {}
    for step in result.steps:
        k = next(
            k for k, c in enumerate(of.choices)
            if (c.task_id, c.option_id) == (step.task_id, step.option_id)
        )  # fmt: skip
        choice, v = of.choices[k], of.vehicles.index(step.vehicle_id)
        assert step.vehicle_id in choice.vehicles
        way = of.travel_ms[v][at.get(step.vehicle_id, len(of.choices))][k]
        assert step.arrive_ms == free[step.vehicle_id] + way
        wait = step.start_ms - step.arrive_ms
        assert wait == next_wait_ms(wait, choice.lap_ms, choice.lap_max_ms)
        assert step.end_ms - step.start_ms == choice.duration_ms
        free[step.vehicle_id], at[step.vehicle_id] = step.end_ms, k
    assert sorted(step.task_id for step in result.steps) == [1, 2, 3, 4]
    assert solve(of, Limits(nodes=500)) == result


@pytest.mark.parametrize("text", ["", ".(p1 p2 p3)", "~(p1 p2 p3)", "+(.(p1 p2) |(p2 p3))"])
def test_small_and_compiled_searches_say_the_same(text, monkeypatch):
    of = problem(5, text, count=3)
    one = solve(of)
    monkeypatch.setattr(assignment_compiled, "SMALL_TASKS", 0)
    monkeypatch.setattr(assignment_compiled, "MODERATE_TASKS", 0)
    two = solve(of)
    assert (one.steps, one.bound, one.nodes) == (two.steps, two.bound, two.nodes)


@pytest.mark.parametrize(
    "text", ["", "~(p1 |(p2 p3 p4) p5 p6)", "+(.(p1 p2) |(p2 p3 p4 p5 p6))_[0-1300]"]
)
def test_a_moderate_search_is_begun_without_the_compiler_and_says_the_same(text, monkeypatch):
    of = problem(5, text, count=6)
    monkeypatch.setattr(assignment_compiled, "SMALL_TASKS", 0)
    with monkeypatch.context() as without:
        without.setattr(assignment_compiled, "MODERATE_TASKS", 0)
        one = solve(of)
    compiled: list[str] = []
    monkeypatch.setattr(assignment_compiled, "machine", lambda f: compiled.append(f.__name__))
    monkeypatch.setattr(tiered, "_chosen", lambda function, _work: function)
    layers.forget()
    two = solve(of)
    assert compiled == []
    assert (one.steps, one.bound, one.nodes) == (two.steps, two.bound, two.nodes)


@pytest.mark.parametrize("semantics", [TIME, ORDER])
@pytest.mark.parametrize(
    "text", [".(p1 p2 p3)-[0-700]", "~(p1 |(p2 p3))-[20-400]", ".(p1 ~(p2 p3)-[0-300])_[0-1500]"]
)
def test_nothing_cheaper_is_found_by_two_solvers(text, semantics):
    for seed in range(3):
        of = problem(seed, text, count=3, semantics=semantics)
        solution, body = certified(of, solve(of), solvers=False)
        if solution.cost is None:
            assert solution.status == "infeasible"
            assert why_infeasible(of)[0]
            continue
        assert solution.status == "optimal"
        assert verify(body).wrong == ""
        assert none_below(of, solution.cost)[0]


def test_an_ineligible_vehicle_gets_nothing():
    of = problem(1, "", count=2)
    only = tuple(replace(c, vehicles=(12,)) for c in of.choices)
    assert {step.vehicle_id for step in solve(replace(of, choices=only)).steps} == {12}


def test_flown_tasks_bind_those_to_come():
    of = problem(3, ".(p1 p2 p3 p4)", ready_ms=(900, 900))
    left = tuple(k for k, c in enumerate(of.choices) if c.task_id != 1)

    def less(rows):
        return tuple(tuple(row[k] for k in left) for row in (*(rows[a] for a in left), rows[-1]))

    rest = replace(
        of, choices=tuple(of.choices[k] for k in left), done=((1, 100, 5000),),
        travel_ms=tuple(less(rows) for rows in of.travel_ms),
    )  # fmt: skip
    for semantics in (TIME, ORDER):
        solution, body = certified(*(lambda p: (p, solve(p)))(replace(rest, semantics=semantics)))
        assert solution.status == "optimal"
        assert verify(body).wrong == ""
        assert sorted(step.task_id for step in solution.steps) == [2, 3, 4]
        early = min(step.start_ms for step in solution.steps)
        assert early >= 5000 if semantics == TIME else early < 5000
    late = replace(rest, done=((1, 901, 5000),))
    with pytest.raises(BadInput, match="begins after a vehicle sets off"):
        solve(late)
    with pytest.raises(BadInput, match="flown and to be flown"):
        solve(replace(of, done=((1, 100, 5000),)))


def test_a_window_after_a_flown_task_counts_from_its_end():
    row_of = ((5, 9), (5, 5), (1, 1))
    of = AssignmentProblem(
        "line", (1,), (50,), (Choice(2, 1, 5, (1,)), Choice(3, 1, 5, (1,))), (row_of,),
        ".(p1 p2 p3)-[0-20]", done=((1, 10, 40),),
    )  # fmt: skip
    assert [s.start_ms for s in solve(of).steps] == [51, 65]
    late = replace(of, done=((1, 10, 30),))
    assert solve(late).status == "infeasible"


def test_alternatives_that_nobody_can_do_are_left_aside():
    of = problem(2, "+(p1 p2)", count=2)
    able = tuple(replace(c, vehicles=()) if c.task_id == 1 else c for c in of.choices)
    assert {s.task_id for s in solve(replace(of, choices=able)).steps} == {2}
    with pytest.raises(BadInput, match="no vehicle is eligible for task 1"):
        solve(replace(of, choices=able, relations="|(p1 p2)"))


def test_best_times_are_chosen_among_the_members_of_a_group():
    # 3 ends within 10 of the last of 1 and 2; the one that waits costs less if it is 2
    chains = [visit(1), visit(2, travel=300), visit(3, travel=1000), visit(4, previous=0)]
    times = earliest(chains, [row(constraint_rows.WITHIN_END, 3, (1, 2), hi=10)])
    assert times.sure
    assert max(times.end_ms) == 1050
    assert times.end_ms[3] < 1050


def test_the_earliest_of_a_group_does_not_creep():
    # 3 starts 1 after the first of 1 and 2, and 1 comes after 3 on the same vehicle
    chains = [visit(3, travel=1, duration=1, lap=0, widest=1 << 40),
              visit(1, previous=0, travel=1, duration=1), visit(2, travel=10**9)]  # fmt: skip
    times = earliest(chains, [row(constraint_rows.AFTER_START, 3, (1, 2), lo=1)])
    assert times.start_ms[0] == 10**9 + 1


@pytest.mark.parametrize("relations", ["", "|(p1 p2)"])
def test_a_task_that_nobody_can_do_is_not_left_out(relations):
    choices, travel = (Choice(1, 1, 10, (1,)),), (((5,), (5,)),)
    problem = AssignmentProblem("unable", (1,), (0,), choices, travel, relations)
    alone = replace(problem, relations="")
    assert solve(alone, Limits()).cost is not None
    with pytest.raises(BadInput, match="no vehicle is eligible for task 2"):
        solve(replace(problem, unable=frozenset({2})), Limits())
