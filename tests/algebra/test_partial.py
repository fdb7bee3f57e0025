"""What a term permits of which some tasks are not done: the definition, sets, rows and pruned terms."""

from __future__ import annotations

from itertools import chain, combinations, permutations
from random import Random

import pytest

from cratous.services.mission.times import all_hold
from cratous.spec import algebra
from cratous.spec.algebra import Term
from cratous.spec.algebra.meaning import branches, rows, satisfied, tasks
from cratous.spec.algebra.partial import (
    after_choices,
    is_whole,
    kept_rows,
    largest_part,
    may_be_done,
    only,
    permits,
)


def random_term(random: Random, timed: bool) -> Term:
    """A term of up to five tasks, some of its parts with a timing."""
    count = [0]

    def made(depth: int) -> str:
        suffix = ""
        if timed and random.random() < 0.3:
            low = random.randrange(0, 3)
            suffix = f"{random.choice('_-')}[{low}-{low + random.randrange(0, 9)}]"
        if depth == 0 or count[0] > 3 or random.random() < 0.25:
            count[0] += 1
            return f"p{count[0]}{suffix}"
        parts = [made(depth - 1) for _ in range(random.randrange(1, 4))]
        return f"{random.choice('..~~|+')}({' '.join(parts)}){suffix}"

    return algebra.parse(made(3))


def subsets(of: tuple[int, ...]) -> list[frozenset[int]]:
    return [frozenset(s) for s in chain(*(combinations(of, n) for n in range(len(of) + 1)))]


def some_times_permit(term: Term, done: frozenset[int]) -> bool:
    """By trying: one task after the other, in every order; and all at once."""
    for order in permutations(done):
        if permits(term, {task: (k, k + 1) for k, task in enumerate(order)}):
            return True
    return False


@pytest.mark.parametrize("seed", range(40))
def test_sets_are_what_some_times_permit(seed: int) -> None:
    """`may_be_done` and `largest_part` against trying every order of every subset."""
    term = random_term(Random(seed), timed=False)
    allowed = [s for s in subsets(tasks(term)) if len(s) < 5]
    for done in allowed:
        assert may_be_done(term, done) == some_times_permit(term, done), (term, done)
        closed = any(
            done <= set(tasks(one)) and largest_part(one, done) == done for one in branches(term)
        )
        assert may_be_done(term, done) == closed, (term, done)
    for one in branches(term):
        for able in subsets(tasks(one)):
            parts = [s for s in subsets(tuple(able)) if may_be_done(one, s)]
            assert largest_part(one, able) == max(parts, key=len)
            assert all(s <= largest_part(one, able) for s in parts)


@pytest.mark.parametrize("seed", range(90))
def test_rows_and_the_pruned_term_say_what_the_definition_says(seed: int) -> None:
    random = Random(1000 + seed)
    term = random_term(random, timed=True)
    for done in subsets(tasks(term)):
        for _ in range(6):
            times = {}
            for task in done:
                start = random.randrange(0, 6)
                times[task] = (start, start + random.randrange(0, 4))
            fitting = [
                one for one in branches(term) if done <= set(tasks(one)) and may_be_done(one, done)
            ]
            by_rows = any(all_hold(kept_rows(one, done), times) for one in fitting)
            assert by_rows == permits(term, times), (term, times)
            pruned = [part for one in fitting if (part := only(one, done)) is not None]
            for one, part in zip(fitting, pruned, strict=False):
                assert tasks(part) == tuple(t for t in tasks(one) if t in done)
                told = {row[:5] for row in rows(part)}
                assert told == {row[:5] for row in kept_rows(one, done)}
            if done:
                assert any(satisfied(part, times) for part in pruned) == by_rows


@pytest.mark.parametrize("seed", range(40))
def test_all_that_is_asked_for_is_a_part_as_well(seed: int) -> None:
    random = Random(2000 + seed)
    term = random_term(random, timed=True)
    for one in branches(term):
        whole = frozenset(tasks(one))
        assert is_whole(term, whole)
        assert may_be_done(term, whole)
        times = {task: (start := random.randrange(0, 9), start + 2) for task in whole}
        assert permits(term, times) == satisfied(term, times)


@pytest.mark.parametrize(
    ("text", "able", "kept"),
    [
        (".(p1 p2 p3)", {1, 3}, {1}),
        (".(p1 p2 p3)", {2, 3}, set()),
        ("|(.(p1 p2) p3)", {2, 3}, {3}),
        ("~(p1 p2)", {2}, set()),
        ("~(|(p1 p2) p3)", {2, 3}, {2, 3}),
        (".(|(p1 p2) p3)", {2, 3}, {2}),
        ("~(.(p1 p2) p3)", {1, 3}, {1, 3}),
    ],
)
def test_what_waits_for_what_is_left_out(text: str, able: set[int], kept: set[int]) -> None:
    assert largest_part(algebra.parse(text), able) == kept


def test_what_was_begun_is_held_back_by_nothing() -> None:
    term = algebra.parse("~(p1 p2)-[0-9]")
    assert largest_part(term, {2}, {2}) == {2}
    left = only(term, {2})
    assert left is not None
    assert rows(left) == ()


def test_a_choice_that_was_begun_is_made() -> None:
    term = algebra.parse("|(+(.(p1 p2) p3) +(p4 p5))")
    assert algebra.format_term(after_choices(term, {1})) == "|(+(.(p1 p2)) +(p4 p5))"
    assert after_choices(term, {1, 3}) == term
