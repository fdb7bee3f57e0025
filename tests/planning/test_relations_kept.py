"""Which rows of a mission's relations count, and what is unknown: the kernels judge the term beside them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cratous.services.loading import load
from cratous.services.mission.times import all_hold
from cratous.services.monitor import relations
from cratous.services.monitor.relations import CHOICES_MAX, branch_rows, is_choice, is_part
from cratous.spec.algebra.meaning import rows as rows_of
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"
PAIRS = 13
EVERY = frozenset(range(1, 2 * PAIRS + 1))
EVEN_MORE = " ".join(f"+(.(p{n} p{n + 1}) .(p{n + 1} p{n}))" for n in range(1, 2 * PAIRS, 2))
"""2^13 branches of the same tasks, more than are gone through one by one."""


def of(text: str, count: int = 2 * PAIRS) -> Mission:
    mission = load(EXAMPLE)
    tasks = tuple(replace(mission.tasks[0], id=n) for n in range(1, count + 1))
    return replace(mission, tasks=tasks, relations=text)


def outcome_of(kept: relations.Kept) -> Outcome:
    return kept.judged(Verdict("G1", "i", Outcome.VIOLATED, Kind.EXACT, "n")).outcome


def test_of_more_branches_than_are_gone_through_the_kept_one_is_found():
    assert 2**PAIRS > CHOICES_MAX
    backwards = {n: (1000 - n, 1000 - n) for n in EVERY}
    kept = branch_rows(of(f"|({EVEN_MORE})"), EVERY, backwards)
    assert kept is not None
    assert (len(kept.rows), kept.doubt) == (PAIRS, "")
    assert all_hold(kept.rows, backwards)
    assert kept.kernels


def test_where_none_is_kept_that_is_known():
    together = dict.fromkeys(EVERY, (0, 10))
    kept = branch_rows(of(f"|({EVEN_MORE})"), EVERY, together)
    assert kept is not None
    assert not all_hold(kept.rows, together)
    assert outcome_of(kept) is Outcome.VIOLATED


def test_where_not_all_branches_were_looked_at_nothing_is_known():
    """A task has not ended, so rows alone are there; the first pair is the last whose order changes."""
    backwards = {n: (1000 - n, 1000 - n) for n in EVERY - {2 * PAIRS}}
    kept = branch_rows(of(f"|({EVEN_MORE})"), EVERY, backwards)
    assert kept is not None
    assert f"only {CHOICES_MAX} of the branches" in kept.doubt
    assert outcome_of(kept) is Outcome.UNKNOWN
    few = of("|(+(.(p1 p2) .(p2 p1)) p3)", 3)
    kept = branch_rows(few, frozenset({1, 2, 3}), {1: (5, 6), 2: (1, 2)})
    assert kept is not None
    assert (kept.doubt, kept.rows[0].i) == ("", 1)


@pytest.mark.parametrize("late", [True, False])
def test_where_rows_and_relations_differ_nothing_is_known(
    late: bool, monkeypatch: pytest.MonkeyPatch
):
    mission = of(".(p1 p2)", 2)
    times = {1: (0, 10), 2: (10, 20) if late else (9, 20)}

    def other(term: object) -> object:
        (row,) = rows_of(term)  # type: ignore[arg-type]
        return (row._replace(lo=1 if late else -1),)

    kept = branch_rows(mission, frozenset({1, 2}), times)
    assert kept is not None
    assert kept.doubt == ""
    monkeypatch.setattr(relations, "rows", other)
    kept = branch_rows(mission, frozenset({1, 2}), times)
    assert kept is not None
    assert outcome_of(kept) is Outcome.UNKNOWN


def test_times_that_no_kernel_is_proved_for_make_nothing_known():
    kept = branch_rows(of(".(p1 p2)", 2), frozenset({1, 2}), {1: (0, 10), 2: (10, 2**62)})
    assert kept is not None
    assert "out of range" in kept.doubt
    assert outcome_of(kept) is Outcome.UNKNOWN


@pytest.mark.parametrize(
    ("text", "chosen", "choice", "part"),
    [
        ("+(.(p1 p2) .(p3 p4))", {1, 2}, True, True),
        ("+(.(p1 p2) .(p3 p4))", {1, 2, 3}, False, False),
        ("+(.(p1 p2) .(p3 p4))", {1}, False, True),
        ("+(.(p1 p2) .(p3 p4))", {2}, False, False),
        ("|(+(p1 p2) p3)", {1, 3}, True, True),
        ("|(+(p1 p2) p3)", {1, 3, 4}, False, False),
        ("", {1, 2, 3, 4}, True, True),
        ("", {1, 2, 3}, False, True),
        ("", set(), False, False),
        (" | ( p01 p2 )", {1, 2}, True, True),
    ],
)
def test_what_is_a_choice_and_what_a_part(text: str, chosen: set[int], choice: bool, part: bool):
    mission = of(text, 4)
    assert is_choice(mission, frozenset(chosen)) == choice
    assert is_part(mission, frozenset(chosen)) == part


def test_a_mission_without_tasks_asks_for_none():
    mission = of("", 0)
    assert is_choice(mission, frozenset())
    assert not is_choice(mission, frozenset({1}))
    assert branch_rows(mission, frozenset(), {}) == relations.Kept(())
    assert branch_rows(mission, frozenset({1}), {}) is None
