"""Terms as data: judged by the kernels as the meaning in `spec` judges them, and read back as their text."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cratous.core.algebra.terms import (
    MASK_BITS,
    TIME_LIMIT_MS,
    Node,
    done_as_permitted,
    kept_operands,
    may_be_done,
    operands_of,
    term_parts,
)
from cratous.services.mission.term_data import checked_nodes, nodes_of, plain, text_of
from cratous.services.mission.times import all_hold
from cratous.spec import algebra
from cratous.spec.algebra import Term, partial
from cratous.spec.algebra.meaning import branch, branches, rows, satisfied, tasks
from cratous.spec.errors import BadInput

BIG = 5


@st.composite
def texts(draw: st.DrawFn) -> str:
    """A term of at most five tasks, with timings; operands of `+` may share tasks."""

    def suffix() -> str:
        if draw(st.integers(0, 2)):
            return ""
        low = draw(st.integers(0, 4))
        return f"{draw(st.sampled_from('_-'))}[{low}-{low + draw(st.integers(0, 9))}]"

    def made(depth: int, pool: list[int]) -> str:
        if depth == 0 or draw(st.integers(0, 4)) == 0:
            return f"p{draw(st.sampled_from(pool))}{suffix()}"
        op = draw(st.sampled_from(".~|+"))
        count = draw(st.integers(1, 3))
        if op == "+":
            pools = [pool] * count
        else:
            mixed = draw(st.permutations(pool))
            count = min(count, len(mixed))
            pools = [list(mixed[k::count]) for k in range(count)]
        parts = [made(depth - 1, one) for one in pools]
        return f"{op}({' '.join(parts)}){suffix()}"

    return made(3, list(range(1, BIG + 1)))


spans = st.tuples(st.integers(0, 6), st.integers(-1, 5)).map(lambda s: (s[0], s[0] + s[1]))
some_times = st.dictionaries(st.integers(1, BIG), spans)


def of(text: str) -> tuple[Term, tuple[Node, ...]]:
    term = algebra.parse(text)
    return term, checked_nodes(term, text)


@given(texts(), some_times)
def test_the_kernels_judge_a_term_as_its_meaning_does(text: str, times: dict[int, tuple[int, int]]):
    term, nodes = of(text)
    assert done_as_permitted(nodes, times, True) == satisfied(term, times)
    assert done_as_permitted(nodes, times, False) == partial.permits(term, times)


@given(texts(), st.frozensets(st.integers(1, BIG)))
def test_sets_of_tasks_are_judged_as_well(text: str, done: frozenset[int]):
    term, nodes = of(text)
    assert may_be_done(nodes, done, True) == partial.is_whole(term, done)
    assert may_be_done(nodes, done, False) == partial.may_be_done(term, done)
    mine = done & set(tasks(term))
    branch_of_them = any(frozenset(tasks(one)) == mine for one in branches(term))
    assert may_be_done(nodes, done, True) == branch_of_them


@given(texts(), some_times)
def test_the_kept_operands_are_a_branch_whose_rows_hold(
    text: str, times: dict[int, tuple[int, int]]
):
    term, nodes = of(text)
    times = {task: span for task, span in times.items() if task in tasks(term)}
    kept = kept_operands(nodes, term_parts(nodes, times, True))
    alike = [one for one in branches(term) if set(tasks(one)) == set(times)]
    forward = all(start <= end for start, end in times.values())
    assume(forward)
    assert (kept is not None) == any(all_hold(rows(one), times) for one in alike)
    if kept is not None:
        one = branch(_with(term, kept), 0)
        assert set(tasks(one)) == set(times)
        assert all_hold(rows(one), times)


def _with(term: Term, kept: dict[int, int]) -> Term:
    """By the tests' own count of places."""
    count = iter(range(10**6))

    def made(part: Term) -> Term:
        if isinstance(part, algebra.Atom):
            next(count)
            return part
        operands = tuple(map(made, part.operands))
        place = next(count)
        return replace(part, operands=(operands[kept[place]],) if place in kept else operands)

    return made(term)


@pytest.mark.parametrize("count", [MASK_BITS - 1, MASK_BITS, MASK_BITS + 1, 3 * MASK_BITS])
def test_there_may_be_more_tasks_than_bits(count: int):
    pairs = " ".join(f"+(p{n} p{n + 1})" for n in range(1, 2 * count, 2))
    _, nodes = of(f".({pairs})")
    first = frozenset(range(1, 2 * count, 2))
    assert may_be_done(nodes, first, True)
    for task in (1, count | 1, 2 * count - 1):
        assert may_be_done(nodes, first - {task} | {task + 1}, True)
        assert not may_be_done(nodes, first | {task + 1}, False)
        assert not may_be_done(nodes, first - {task}, True)


def test_choices_that_nobody_could_go_through():
    """2^200 branches of the same tasks."""
    pairs = " ".join(f"+(.(p{n} p{n + 1}) .(p{n + 1} p{n}))" for n in range(1, 401, 2))
    _, nodes = of(f"|({pairs})")
    backwards = {n: (1000 - n, 1000 - n) for n in range(1, 401)}
    assert done_as_permitted(nodes, backwards, True)
    assert kept_operands(nodes, term_parts(nodes, backwards, True))
    together = {**backwards, 7: (900, 950), 8: (940, 990)}
    assert not done_as_permitted(nodes, together, True)


# ---- data --------------------------------------------------------------------------------------


@given(texts())
def test_data_print_to_their_text(text: str):
    term, nodes = of(text)
    assert algebra.parse(text_of(nodes)) == term


@pytest.mark.parametrize(
    "text", ["p01", " . ( p1\n~(p002 +(p3 p4)_[00-5] ) p10 ) - [ 10 - 200 ]", "|(p100 p200)"]
)
def test_blanks_and_leading_zeros_say_nothing(text: str):
    term, nodes = of(text)
    assert text_of(nodes) == plain(text) == plain(algebra.format_term(term))


@pytest.mark.parametrize(
    ("text", "other"),
    [
        (".(p1 p2)", ".(p2 p1)"),
        (".(p1 p2)", "~(p1 p2)"),
        ("p1_[0-5]", "p1-[0-5]"),
        ("|(p1 p2)", "|(p1 |(p2))"),
        ("p10", "p1"),
        ("p1_[0-5]", "p1_[0-50]"),
    ],
)
def test_data_of_another_text_are_refused(text: str, other: str):
    with pytest.raises(BadInput, match="not those of the text"):
        checked_nodes(algebra.parse(other), text)


@pytest.mark.parametrize(
    "nodes",
    [
        (),
        (Node(0, 0, 1, 0, 0, 0), Node(0, 0, 2, 0, 0, 0)),
        (Node(0, 0, 1, 0, 0, 0), Node(1, 2, 0, 0, 0, 0)),
        (Node(1, 0, 0, 0, 0, 0),),
        (Node(0, 0, 1, 0, 0, 0), Node(0, 1, 2, 0, 0, 0)),
        (Node(0, 0, 1, 0, 0, 0), Node(3, -1, 0, 0, 0, 0)),
    ],
)
def test_what_is_not_one_term_is_refused(nodes: tuple[Node, ...]):
    with pytest.raises(BadInput):
        operands_of(nodes)
    with pytest.raises(BadInput):
        term_parts(nodes, {}, True)


@pytest.mark.parametrize(
    "node", [Node(5, 1, 0, 0, 0, 0), Node(-1, 1, 0, 0, 0, 0), Node(3, 1, 0, 3, 0, 0)]
)
def test_unknown_codes_are_refused(node: Node):
    with pytest.raises(BadInput):
        term_parts((Node(0, 0, 1, 0, 0, 0), node), {}, True)


def test_times_out_of_the_range_of_the_proofs_are_refused():
    nodes = nodes_of(algebra.parse(".(p1 p2)"))
    with pytest.raises(BadInput, match="out of range"):
        term_parts(nodes, {1: (0, TIME_LIMIT_MS)}, False)
    with pytest.raises(BadInput, match="out of range"):
        term_parts((Node(0, 0, 1, 1, 0, TIME_LIMIT_MS),), {}, False)
