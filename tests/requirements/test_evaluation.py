"""Requirements over time: evaluation sample by sample against the list of all samples, by brute force."""

from __future__ import annotations

import itertools
import math
from itertools import accumulate

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.requirements.since import since_holds
from cratous.core.requirements.until import until_holds
from cratous.services.requirements.evaluation import Evaluation, TooManyWait
from cratous.services.requirements.formula import (
    MAX_TIME,
    TRUE,
    Always,
    Bounded,
    Join,
    Not,
    Reaches,
    eventually,
    globally,
    horizon,
    once,
    signals,
    waiting,
)
from cratous.spec.errors import BadInput
from cratous.spec.requirements.operators import Meant, since_step, until_step

VALUES = st.sampled_from([0.0, 1.0, 2.0, None, math.nan])
NAMES = ("x", "y")


@st.composite
def traces(draw):
    gaps = draw(st.lists(st.integers(1, 4), max_size=12))
    times = accumulate(gaps, initial=draw(st.integers(-5, 5)))
    return [(time, {name: draw(VALUES) for name in NAMES}) for time in times]


@st.composite
def bounds(draw):
    low = draw(st.integers(0, 6))
    return low, low + draw(st.integers(0, 8))


LEAVES = st.one_of(
    st.sampled_from([Always(0), TRUE]),
    st.builds(Reaches, st.sampled_from(NAMES), st.sampled_from([1.0, 2.0, "x"])),
)
FORMULAS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.builds(Not, inner),
        st.builds(Join, inner, inner, st.booleans()),
        st.builds(
            lambda phi, psi, b, past: Bounded(phi, psi, *b, past),
            inner,
            inner,
            bounds(),
            st.booleans(),
        ),
    ),
    max_leaves=5,
)


def meaning(formula, trace, i):
    """The verdict at sample i: the definition, read off the whole list."""
    time, values = trace[i]
    if isinstance(formula, Always):
        return formula.verdict
    if isinstance(formula, Reaches):
        sides = [values[s] if isinstance(s, str) else s for s in (formula.left, formula.right)]
        if any(side is None or math.isnan(side) for side in sides):
            return 1
        return 2 if sides[0] >= sides[1] else 0
    if isinstance(formula, Not):
        return 2 - meaning(formula.phi, trace, i)
    if isinstance(formula, Join):
        both = meaning(formula.phi, trace, i), meaning(formula.psi, trace, i)
        return min(both) if formula.is_and else max(both)
    best = 0
    for j in range(i + 1) if formula.past else range(i, len(trace)):
        if formula.low <= abs(trace[j][0] - time) <= formula.high:
            between = range(j + 1, i + 1) if formula.past else range(i, j)
            held = [meaning(formula.phi, trace, k) for k in between]
            best = max(best, min([meaning(formula.psi, trace, j), *held]))
    return best


def run(formula, trace):
    evaluation = Evaluation(formula)
    return [evaluation.sample(time, values) for time, values in trace]


@settings(max_examples=400, deadline=None)
@given(FORMULAS, traces())
def test_verdicts_are_those_of_the_whole_trace(formula, trace):
    rows = [row for got in run(formula, trace) for row in got]
    assert [time for time, _ in rows] == [time for time, _ in trace][: len(rows)]
    for number, (_, verdict) in enumerate(rows):
        assert verdict == meaning(formula, trace, number)
    ended = [time for time, _ in trace if time + horizon(formula) <= trace[-1][0]]
    assert len(rows) >= len(ended)


@settings(max_examples=150, deadline=None)
@given(traces(), bounds())
def test_an_until_waits_only_where_the_trace_can_go_on_both_ways(trace, bound):
    formula = Bounded(Reaches("x", 1.0), Reaches("y", 1.0), *bound, False)
    decided = sum(len(got) for got in run(formula, trace))
    for i in range(decided, len(trace)):
        last, at = trace[-1][0], trace[i][0]
        soon = max(last + 1, at + bound[0])
        verdicts = {
            meaning(formula, [*trace, (soon, {"x": value, "y": value})], i) for value in (0.0, 2.0)
        }
        assert len(verdicts) == 2


ITEMS = st.lists(st.tuples(st.integers(-4, 14), st.integers(0, 2), st.integers(0, 2)), max_size=10)


@given(ITEMS, st.integers(-4, 14), bounds())
def test_folds_are_their_definitions_whatever_order_comes(items, at, bound):
    for fold, step in ((until_holds, until_step), (since_holds, since_step)):
        meant = Meant(-(2**62), 2, 0)
        for item in items:
            meant = step(meant, *item, at, *bound)
        assert fold(items, at, *bound) == meant.value


def test_a_response_is_told_at_the_sample_that_decides_it():
    answered = eventually(Reaches("x", 1.0), 0, 10_000)
    trace = [(0, {"x": 0.0}), (4_000, {"x": 0.0}), (6_000, {"x": 1.0}), (30_000, {"x": 0.0})]
    assert run(answered, trace) == [[], [], [(0, 2), (4_000, 2), (6_000, 2)], []]
    kept = globally(Reaches("x", 1.0), 0, 10_000)
    assert run(kept, trace) == [[(0, 0)], [(4_000, 0)], [], [(6_000, 2), (30_000, 0)]]


def test_a_missing_signal_is_unknown_and_never_true():
    assert run(Not(Reaches("x", 1.0)), [(0, {}), (1, {"x": math.nan})]) == [[(0, 1)], [(1, 1)]]
    assert run(once(Reaches("x", 1.0), 0, 5), [(0, {"x": 2.0}), (5, {}), (6, {})]) == [
        [(0, 2)],
        [(5, 2)],
        [(6, 1)],
    ]


@pytest.mark.parametrize("time", [5, 4, MAX_TIME + 1])
def test_a_sample_out_of_order_is_refused_and_changes_nothing(time):
    evaluation = Evaluation(once(Reaches("x", 1.0), 0, 5))
    evaluation.sample(5, {"x": 1.0})
    with pytest.raises(BadInput, match="out of order"):
        evaluation.sample(time, {"x": 0.0})
    assert evaluation.sample(6, {"x": 0.0}) == [(6, 2)]


def test_memory_is_bounded():
    evaluation = Evaluation(eventually(Reaches("x", 1.0), 0, 100), most=10)
    for time in range(10):
        evaluation.sample(time, {"x": 0.0})
    with pytest.raises(TooManyWait, match="at most 10"):
        evaluation.sample(10, {"x": 0.0})


@pytest.mark.parametrize(("low", "high"), [(-1, 2), (3, 2), (0, MAX_TIME + 1)])
def test_bounds_that_are_none_are_refused(low, high):
    with pytest.raises(BadInput, match="no bounds of time"):
        eventually(TRUE, low, high)


def test_deep_formulas_take_no_recursion():
    formula = Reaches("x", "y")
    for _ in range(20_000):
        formula = Not(formula)
    assert signals(formula) == ("x", "y")
    assert run(formula, [(0, {"x": 1.0, "y": 1.0})]) == [[(0, 2)]]


@settings(max_examples=200, deadline=None)
@given(formula=FORMULAS, trace=traces(), more=st.integers(0, 40))
def test_no_queue_is_longer_than_was_known_before(formula, trace, more):
    """Whatever comes, where samples are no closer than the period."""
    last = trace[-1][0]
    trace = [*trace, *((last + k, {"x": 1.0, "y": None}) for k in range(1, more + 1))]
    period = min((b - a for (a, _), (b, _) in itertools.pairwise(trace)), default=1)
    most = waiting(formula, period)
    evaluation = Evaluation(formula)
    for time, values in trace:
        evaluation.sample(time, values)
        assert max((getattr(node, "size", 0) for node in evaluation.nodes), default=0) <= most


def test_what_waits_at_most_is_reached():
    formula = eventually(Reaches("x", 1.0), 0, 10)
    evaluation = Evaluation(formula)
    sizes = []
    for time in range(30):
        evaluation.sample(time, {"x": 0.0})
        sizes.append(max(getattr(node, "size", 0) for node in evaluation.nodes))
    assert waiting(formula, 1) == 11
    assert max(sizes) in (10, 11)
    assert waiting(formula, 5) == 3
