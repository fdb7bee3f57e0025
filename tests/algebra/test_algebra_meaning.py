"""The meaning of the process algebra: rows against the definition on composites, and orders."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cratous.spec.algebra import Atom, Op, Suffix, Term, format_term, parse
from cratous.spec.algebra.meaning import (
    branch,
    branches,
    complete,
    count_branches,
    idle_timings,
    next_actions,
    rows,
    runs,
    satisfied,
    tasks,
)
from cratous.spec.constraint_rows import Row

SUFFIXES = st.none() | st.builds(
    lambda kind, t1, more: Suffix(kind, t1, t1 + more),
    st.sampled_from(["absolute", "relative"]),
    st.integers(0, 4),
    st.integers(0, 8),
)


@st.composite
def terms(draw, pool=(1, 2, 3, 4, 5), depth=3, timing=True) -> Term:
    """A term over some of the pool; operands share tasks only under `+`."""
    suffix = draw(SUFFIXES) if timing else None
    if depth == 0 or len(pool) == 1 or draw(st.integers(0, 3)) == 0:
        return Atom(draw(st.sampled_from(pool)), suffix)
    op = draw(st.sampled_from(".~|+"))
    count = draw(st.integers(1, min(3, len(pool))))
    if op == "+":
        pools = [pool] * count
    else:
        order = draw(st.permutations(pool))
        cuts = sorted(draw(st.permutations(range(1, len(pool))))[: count - 1])
        pools = [tuple(order[a:b]) for a, b in zip([0, *cuts], [*cuts, None], strict=True)]
    operands = tuple(draw(terms(part, depth - 1, timing)) for part in pools)
    return Op(op, operands, suffix)


def holds(row: Row, times: dict[int, tuple[int, int]]) -> bool:
    """A row, evaluated plainly."""
    start, end = times[row.i]
    if row.kind in (5, 6):
        return start >= row.lo if row.kind == 5 else end <= row.hi
    ends = row.kind in (1, 3)
    ref = max(times[j][1] for j in row.group) if ends else min(times[j][0] for j in row.group)
    return start >= ref + row.lo if row.kind in (1, 2) else end <= ref + row.hi


def by_rows(term: Term, times: dict[int, tuple[int, int]]) -> bool:
    started = set(tasks(term)) & set(times)
    return any(
        set(tasks(one)) == started and all(holds(row, times) for row in rows(one))
        for one in branches(term)
    )


def earliest(one: Term, lengths: dict[int, int]) -> dict[int, tuple[int, int]]:
    """The componentwise earliest times under all lower bounds of a branch."""
    times = {task: (0, lengths[task]) for task in tasks(one)}
    for _ in range(len(times) + 1):
        for row in rows(one):
            while row.kind in (1, 2, 5) and not holds(row, times):
                start, end = times[row.i]
                times[row.i] = (start + 1, end + 1)
    return times


LENGTHS = st.fixed_dictionaries({task: st.integers(0, 3) for task in range(1, 6)})


@given(terms())
def test_canonical_text_is_the_inverse_of_parsing(term):
    assert parse(format_term(term)) == term


@settings(max_examples=300)
@given(terms(), LENGTHS, st.data())
def test_rows_say_what_the_definition_says_near_the_boundary(term, lengths, data):
    one = branch(term, data.draw(st.integers(0, count_branches(term) - 1)))
    times = earliest(one, lengths)
    for task in data.draw(st.lists(st.sampled_from(tasks(one)), max_size=2)):
        shift = data.draw(st.integers(-2, 4))
        times[task] = (times[task][0] + shift, times[task][1] + shift)
    assert satisfied(term, times) == by_rows(term, times)


@given(
    terms(),
    st.dictionaries(
        st.integers(1, 5),
        st.tuples(st.integers(0, 9), st.integers(0, 4)).map(lambda x: (x[0], x[0] + x[1])),
    ),
)
def test_rows_say_what_the_definition_says_for_any_times(term, times):
    assert satisfied(term, times) == by_rows(term, times)


@given(terms(timing=False), LENGTHS, st.data())
def test_without_timing_the_earliest_times_of_every_branch_satisfy(term, lengths, data):
    one = branch(term, data.draw(st.integers(0, count_branches(term) - 1)))
    assert satisfied(term, earliest(one, lengths))


@given(terms())
def test_branches_have_no_choice_left_and_are_counted(term):
    found = list(islice(branches(term), 50))
    assert len(found) == min(50, count_branches(term))
    for one in found:
        assert "+" not in format_term(one)
        assert set(tasks(one)) <= set(tasks(term))
        assert list(branches(one)) == [one]
        assert satisfied(strip(term), earliest(strip(one), dict.fromkeys(range(6), 1)))


def strip(term: Term) -> Term:
    """The term without any timing."""
    if isinstance(term, Atom):
        return replace(term, suffix=None)
    return replace(term, suffix=None, operands=tuple(map(strip, term.operands)))


@given(terms())
def test_every_order_flown_one_by_one_satisfies_the_order(term):
    found = list(runs(term, 30))
    assert len(set(found)) == len(found)
    assert found == sorted(found)
    for run in found:
        times = {task: (2 * place, 2 * place + 1) for place, task in enumerate(run)}
        assert satisfied(strip(term), times)
        assert complete(term, run)
        for place, task in enumerate(run):
            assert task in next_actions(term, run[:place])


@settings(max_examples=200)
@given(terms(), LENGTHS, st.permutations(range(6)), st.data())
def test_every_schedule_sorted_by_start_is_an_order(term, lengths, jitter, data):
    one = branch(term, data.draw(st.integers(0, count_branches(term) - 1)))
    times = {
        task: (start * 10 + jitter[task], end * 10 + 10 * data.draw(st.integers(0, 2)) + 9)
        for task, (start, end) in earliest(strip(one), lengths).items()
    }
    assume(satisfied(strip(term), times))
    order = tuple(sorted(times, key=lambda task: times[task]))
    assert complete(term, order)


# ---- the decisions, one by one --------------------------------------------------------------


def yes_no(text: str, times: dict[int, tuple[int, int]]) -> bool:
    term = parse(text)
    answer = satisfied(term, times)
    assert by_rows(term, times) == answer
    return answer


CASES = [
    # `.` and `~` hold in time; touching is allowed
    (".(p1 p2)", {1: (0, 10), 2: (10, 20)}, True),
    (".(p1 p2)", {1: (0, 10), 2: (9, 20)}, False),
    ("~(p1 p2)", {1: (5, 10), 2: (5, 6)}, True),
    ("~(p1 p2)", {1: (5, 10), 2: (4, 6)}, False),
    ("|(p1 p2)", {1: (5, 10), 2: (0, 99)}, True),
    ("|(p1 p2)", {1: (5, 10)}, False),
    (".(|(p1 p2) p3)", {1: (0, 5), 2: (0, 9), 3: (8, 9)}, False),
    ("~(|(p1 p2) p3)", {1: (7, 9), 2: (3, 9), 3: (3, 4)}, True),
    (".(p1 p2 p3)", {1: (0, 9), 2: (9, 9), 3: (8, 9)}, False),
    # exactly one operand of `+`
    ("+(p1 p2)", {1: (0, 1)}, True),
    ("+(p1 p2)", {1: (0, 1), 2: (0, 1)}, False),
    ("+(p1 p2)", {}, False),
    ("+(p1 |(p1 p2))", {1: (0, 1), 2: (0, 1)}, True),
    ("+(.(p1 p2) .(p2 p1))", {1: (5, 6), 2: (0, 5)}, True),
    ("+(.(p1 p2) .(p2 p1))", {1: (4, 6), 2: (0, 5)}, False),
    # absolute
    ("|(p1 p2)_[5-10]", {1: (5, 6), 2: (9, 10)}, True),
    ("|(p1 p2)_[5-10]", {1: (4, 6), 2: (9, 10)}, False),
    ("|(p1 p2)_[5-10]", {1: (5, 6), 2: (9, 11)}, False),
    # relative under `|`, `+` or on a task is absolute
    ("|(p1 p2)-[5-10]", {1: (5, 6), 2: (9, 11)}, False),
    ("p1-[5-10]", {1: (4, 6)}, False),
    ("p1-[5-10]", {1: (5, 10)}, True),
    ("+(.(p1 p2) p3)-[5-10]", {1: (5, 6), 2: (6, 10)}, True),
    ("+(.(p1 p2) p3)-[5-10]", {1: (4, 6), 2: (9, 10)}, False),
    # relative under `.`: from the end of the operand before, first operand free
    (".(p1 p2)-[5-10]", {1: (90, 100), 2: (105, 110)}, True),
    (".(p1 p2)-[5-10]", {1: (90, 100), 2: (104, 110)}, False),
    (".(p1 p2)-[5-10]", {1: (90, 100), 2: (105, 111)}, False),
    (".(p1 p2 p3)-[5-10]", {1: (0, 1), 2: (6, 11), 3: (16, 21)}, True),
    (".(p1 p2 p3)-[5-10]", {1: (0, 1), 2: (6, 11), 3: (15, 21)}, False),
    # relative under `~`: from the start of the operand before
    ("~(p1 p2)-[5-10]", {1: (90, 999), 2: (95, 100)}, True),
    ("~(p1 p2)-[5-10]", {1: (90, 999), 2: (95, 101)}, False),
    ("~(|(p1 p2) p3)-[5-10]", {1: (90, 91), 2: (50, 99), 3: (55, 60)}, True),
    # the innermost timing wins, per task
    ("|(p1 |(p2 p3)_[1000-1500])_[100-3000]", {1: (100, 3000), 2: (1000, 1500), 3: (1000, 1001)}, True),
    ("|(p1 |(p2 p3)_[1000-1500])_[100-3000]", {1: (100, 3000), 2: (1000, 2999), 3: (1000, 1001)}, False),
    ("|(p1 |(p2 p3)_[1000-1500])_[2000-3000]", {1: (2000, 3000), 2: (1000, 1500), 3: (1000, 1001)}, True),
    # the first operand of a relative `.` stays with the outer timing, the later ones do not
    (".(p1 p2)-[5-50]", {1: (0, 1), 2: (6, 51)}, True),
    ("|(.(p1 p2)-[5-50] p3)_[10-20]", {1: (10, 20), 2: (25, 70), 3: (10, 20)}, True),
    ("|(.(p1 p2)-[5-50] p3)_[10-20]", {1: (9, 20), 2: (25, 70), 3: (10, 20)}, False),
    ("+(.(p1 p2)-[5-50] p3)_[10-20]", {1: (10, 20), 2: (25, 70)}, True),
    ("+(.(p1 p2)-[5-50] p3)_[10-20]", {1: (10, 21), 2: (26, 70)}, False),
    # a timing inside a later operand overrides the relative one, but never the order
    (".(p1 p2_[0-900])-[5-10]", {1: (0, 100), 2: (100, 900)}, True),
    (".(p1 p2_[0-900])-[5-10]", {1: (0, 100), 2: (99, 900)}, False),
    # other tasks say nothing
    ("p1", {1: (0, 1), 7: (0, 1)}, True),
    # no interval ends before it starts
    ("p1", {1: (2, 1)}, False),
]  # fmt: skip


@pytest.mark.parametrize(("text", "times", "answer"), CASES, ids=lambda value: str(value)[:50])
def test_decisions(text, times, answer):
    ordered = all(start <= end for start, end in times.values())
    assert (yes_no(text, times) if ordered else satisfied(parse(text), times)) == answer


def test_rows_name_their_term_in_words():
    found = {row.text for row in rows(parse(".(p1 |(p2 p3))-[5-10]"))}
    said = "`.(p1 |(p2 p3))-[5-10]`"
    assert f"{said}: p2 starts no earlier than p1 ends" in found
    assert f"{said}: p3 starts at least 5 ms after p1 ends" in found
    assert f"{said}: p3 ends at most 10 ms after p1 ends" in found
    assert len(found) == 6
    assert rows(parse(".(p1 p2)")) == (
        Row(1, 2, (1,), 0, 0, "`.(p1 p2)`: p2 starts no earlier than p1 ends"),
    )
    assert rows(parse("~(|(p1 p2) p3)")) == (
        Row(2, 3, (1, 2), 0, 0,
            "`~(|(p1 p2) p3)`: p3 starts no earlier than the first of p1 p2 starts"),
    )  # fmt: skip
    assert rows(parse("p1_[3-9]")) == (
        Row(5, 1, (), 3, 0, "`p1_[3-9]`: p1 starts at 3 ms or later"),
        Row(6, 1, (), 0, 9, "`p1_[3-9]`: p1 ends at 9 ms or earlier"),
    )


def test_rows_of_a_choice_are_refused():
    with pytest.raises(ValueError, match="resolve"):
        rows(parse("|(p1 +(p2 p3))"))


def test_branch_numbers_have_an_end():
    with pytest.raises(IndexError):
        branch(parse("+(p1 p2)"), 2)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("+(p1 p2)_[1-2]", ["p1_[1-2]", "p2_[1-2]"]),
        ("+(.(p1 p2) p3)-[1-2]", [".(p1 p2)_[1-2]", "p3_[1-2]"]),
        ("+(p1_[3-4] p2)_[1-2]", ["p1_[3-4]", "p2_[1-2]"]),
        ("+(p1-[3-4] p2)-[1-2]", ["p1-[3-4]", "p2_[1-2]"]),
        ("+(~(p1 p2)-[3-4] p3)_[1-2]", ["|(~(p1 p2)-[3-4])_[1-2]", "p3_[1-2]"]),
        ("+(+(p1 p2)_[3-4] p3)_[1-2]", ["p1_[3-4]", "p2_[3-4]", "p3_[1-2]"]),
        (".(+(p1 p2) +(p3 p4))", [".(p1 p3)", ".(p1 p4)", ".(p2 p3)", ".(p2 p4)"]),
    ],
)
def test_branches_in_order_with_the_timing_of_the_choice(text, expected):
    assert [format_term(one) for one in branches(parse(text))] == expected


def test_many_branches_are_not_enumerated_to_be_counted():
    text = "|(" + " ".join(f"+(p{2 * n} p{2 * n + 1})" for n in range(1, 101)) + ")"
    term = parse(text)
    assert count_branches(term) == 2**100
    assert len(tasks(next(branches(term)))) == 100
    assert tasks(branch(term, 2**100 - 1))[-1] == 201


@pytest.mark.parametrize(
    ("text", "idle"),
    [
        ("|(p1_[1-2] p2_[1-2])_[0-9]", ["|(p1_[1-2] p2_[1-2])_[0-9]"]),
        (".(p1)-[1-2]", [".(p1)-[1-2]"]),
        (".(p1 p2_[3-4])-[1-2]", [".(p1 p2_[3-4])-[1-2]"]),
        ("|(p1_[1-2] p2)_[0-9]", []),
        (".(p1 p2)", []),
    ],
)
def test_timings_that_bound_nothing_are_found(text, idle):
    assert [format_term(part) for part in idle_timings(parse(text))] == idle


@pytest.mark.parametrize(
    ("text", "done", "following", "is_complete"),
    [
        (".(p1 p2)", (), {1}, False),
        (".(p1 p2)", (1,), {2}, False),
        (".(p1 p2)", (1, 2), set(), True),
        (".(p1 p2)", (2,), set(), False),
        ("~(|(p1 p2) p3)", (2,), {1, 3}, False),
        ("~(|(p1 p2) p3 p4)", (2,), {1, 3}, False),
        ("~(~(p1 p2) p3)", (1,), {2, 3}, False),
        ("~(p3 ~(p1 p2) p4)", (3, 1), {2, 4}, False),
        ("~(p1 p2 p3)", (1,), {2}, False),
        ("+(.(p1 p2) .(p1 p3))", (1,), {2, 3}, False),
        ("+(p1 .(p1 p2))", (1,), {2}, True),
        ("|(+(p1 p2) p3)", (2,), {3}, False),
        ("p1", (9,), set(), False),
    ],
)
def test_what_may_come_next(text, done, following, is_complete):
    term = parse(text)
    assert next_actions(term, done) == frozenset(following)
    assert complete(term, done) is is_complete


def test_runs_are_lazy_and_limited():
    term = parse("|(" + " ".join(f"p{n}" for n in range(1, 1201)) + ")")
    assert [len(run) for run in runs(term, 2)] == [1200, 1200]
    assert list(runs(parse("|(p2 p1)"), 0)) == []


def test_a_run_may_be_the_beginning_of_another():
    assert list(runs(parse("+(p1 .(p1 p2))"))) == [(1,), (1, 2)]
