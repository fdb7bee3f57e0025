"""A whole trace at once gives what sample by sample gives: verdicts, when each was known, margins, blame."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cratous.core.readings.machine import compiled
from cratous.services.requirements import finished_trace, watch
from cratous.services.requirements import formula as form
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Requirement, Signal, Specification
from cratous.services.requirements.watch import Watch
from cratous.spec.errors import BadInput

SIDES = st.sampled_from(("x", "y", 0.0, 1.0))
NAMES = st.sampled_from(("x", "y"))
LEAVES = (
    st.builds(form.Reaches, NAMES, SIDES)
    | st.builds(form.Reaches, SIDES, NAMES)
    | st.sampled_from((form.Always(0), form.Always(2)))
)
FORMULAS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.builds(form.Not, inner),
        st.builds(form.Join, inner, inner, st.booleans()),
        st.builds(form.iff, inner, inner),
        st.builds(lambda p, q, low, more, past: form.Bounded(p, q, low, low + more, past),
                  inner, inner, st.integers(0, 3), st.integers(0, 4), st.booleans()),
    ),
    max_leaves=9,
)  # fmt: skip
VALUES = st.sampled_from((0.0, 1.0, 2.0, None, math.nan, math.inf))
EACH = st.lists(st.tuples(st.integers(1, 3), VALUES, VALUES), max_size=14)
HELD = st.lists(st.tuples(VALUES, VALUES, st.integers(1, 4)), max_size=5).map(
    lambda held: [(1 + k % 2, x, y) for x, y, times in held for k in range(times)]
)
"""Signals that are for some samples as they were."""
ROWS = EACH | HELD
SIGNALS = {name: Signal("float", "m") for name in "xy"}


def plainly(function: Callable[..., Any]) -> Callable[..., Any]:
    return function


def samples(rows: list[tuple[int, Any, Any]]) -> list[tuple[int, dict[str, float | None]]]:
    found, time = [], -1
    for later, x, y in rows:
        time += later
        found.append((time, {"x": x, "y": y}))
    return found


def both_ways(formula: form.Formula, rows: list[tuple[int, Any, Any]]) -> tuple[Outcome, Outcome]:
    spec = Specification(SIGNALS, (Requirement("A", "", formula),))
    one_by_one, at_once = Watch(spec), Watch(spec)
    for time, row in samples(rows):
        one_by_one.sample(time, row)
    columns = finished_trace.Columns("xy")
    for time, row in samples(rows):
        columns.add(time, row)
    finished_trace.Whole(columns).fill(at_once.outcomes[0], formula)
    at_once.count, at_once.last = len(rows), columns.last if rows else -1
    return one_by_one.result().outcomes[0], at_once.result().outcomes[0]


@settings(max_examples=300, deadline=None)
@given(formula=FORMULAS, rows=ROWS)
@example(
    formula=form.Bounded(
        form.Bounded(form.Always(2), form.Reaches("x", 1.0), 0, 4, False),
        form.Reaches("y", 1.0),
        0,
        2,
        False,
    ),
    rows=[(1, 0.0, 1.0), (1, 0.0, 0.0), (1, 0.0, 1.0), (1, 1.0, None), (1, 0.0, 0.0)],
)
@example(  # violated first at a sample that is as the one before, by comparisons that are not made again
    formula=form.Join(
        form.Join(form.Reaches("x", 1.0), form.Reaches("y", 1.0), True),
        form.Not(form.Bounded(form.Always(2), form.Reaches("y", 0.0), 1, 5, True)),
        False,
    ),
    rows=[(1, 0.0, 0.0), (1, 0.0, 0.0)],
)
@example(  # a part that one with time and one without read
    formula=form.iff(form.Reaches("x", 1.0), form.once(form.Reaches("y", 1.0), 0, 9)),
    rows=[(1, 0.0, 0.0), (1, 0.0, 0.0), (1, 1.0, 0.0)],
)
def test_any_formula_over_any_trace(
    formula: form.Formula, rows: list[tuple[int, Any, Any]]
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compiled, "machine", plainly)
        one_by_one, at_once = both_ways(formula, rows)
    assert vars(at_once) == vars(one_by_one)


@settings(max_examples=200, deadline=None)
@given(formula=FORMULAS, rows=ROWS)
def test_each_sample_is_decided_when_it_is_one_by_one(
    formula: form.Formula, rows: list[tuple[int, Any, Any]]
) -> None:
    evaluation, wanted = Evaluation(formula), {}
    for k, (time, row) in enumerate(samples(rows)):
        wanted |= {at: (verdict, k) for at, verdict in evaluation.sample(time, row)}
    columns = finished_trace.Columns("xy")
    for time, row in samples(rows):
        columns.add(time, row)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compiled, "machine", plainly)
        verdict, known = finished_trace.Whole(columns)._parts(formula)[id(formula)]
    assert wanted == {
        at: (int(v), int(k))
        for (at, _), v, k in zip(samples(rows), verdict, known, strict=True)
        if k < len(rows)
    }


def test_machine_code_says_the_same_and_is_used_where_it_is_worth_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every loop, through the monitor of a trace."""
    x, y = form.Reaches("x", 1.0), form.Reaches("y", 1.0)
    a = form.Join(
        form.Bounded(x, form.Not(form.Reaches("y", 2.0)), 1, 3, True),
        form.Bounded(form.Not(form.Reaches("x", 1.5)), y, 1, 4, False),
        False,
    )
    b = form.Join(form.Reaches("x", 0.0), form.Reaches("y", 0.0), True)
    spec = Specification(
        {name: Signal("float") for name in "xy"}, (Requirement("A", "", a), Requirement("B", "", b))
    )
    lines = [
        f"{k * 7 % 5 / 2 - (k == 400)},{k * 11 % 13 / 4 if k % 97 else ''}\n" for k in range(600)
    ]
    (tmp_path / "t.csv").write_text("x,y\n" + "".join(lines))
    one_by_one = watch.watch(spec, tmp_path / "t.csv")
    filled: list[str] = []
    real = finished_trace.Whole.fill
    monkeypatch.setattr(
        finished_trace.Whole, "fill", lambda *words: filled.append(words[1].name) or real(*words)
    )
    monkeypatch.setattr(finished_trace, "WORTH", 1000)
    at_once = watch.watch(spec, tmp_path / "t.csv")
    assert filled == ["A", "B"]
    assert at_once == one_by_one
    first, second = at_once.outcomes
    assert first.violated > 0 < first.unknown
    assert (second.violated, second.first_violated) == (1, 400)
    assert min((m.least, m.at) for m in second.margins) == (-1.0, 400)


@pytest.mark.parametrize("later", [7, 6, form.MAX_TIME + 1, 2**63])
def test_times_that_do_not_rise_are_refused_at_once_as_one_by_one(
    later: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(finished_trace, "WORTH", 0)
    monkeypatch.setattr(compiled, "machine", plainly)
    spec = Specification(SIGNALS, (Requirement("A", "", form.Reaches("x", 1.0)),))
    row: dict[str, float | None] = {"x": 1.0}
    one_by_one = Watch(spec)
    one_by_one.sample(7, row)
    with pytest.raises(BadInput) as wanted:
        one_by_one.sample(later, row)
    with pytest.raises(BadInput) as found:
        Watch(spec).all([(7, row), (later, row)])
    assert str(found.value) == str(wanted.value)


def test_a_trace_longer_than_is_kept_goes_on_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    spec = Specification(SIGNALS, (Requirement("A", "", form.Reaches("x", 1.0)),))
    rows = samples([(1, k % 3 / 1.0, None) for k in range(50)])
    wanted = Watch(spec)
    for time, row in rows:
        wanted.sample(time, row)
    monkeypatch.setattr(watch, "MOST", 20)
    found = Watch(spec)
    found.all(rows)
    assert found.result() == wanted.result()
