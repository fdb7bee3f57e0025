"""Which tasks a mission asks for: one branch, whatever was accepted; and who takes part when."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.loading import load
from cratous.spec import algebra
from cratous.spec.algebra.meaning import branches, tasks
from cratous.spec.mission import Change, Mission, changes
from cratous.spec.mission.asked import asked, best_branch
from cratous.spec.mission.changes import asked_by, known_at

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "popup" / "mission.yaml"


@st.composite
def texts(draw: st.DrawFn) -> str:
    """A term with the tasks 1, 2, ... each once."""
    count = [0]

    def made(depth: int) -> str:
        if depth == 0 or draw(st.integers(0, 2)) == 0:
            count[0] += 1
            return f"p{count[0]}"
        parts = [made(depth - 1) for _ in range(draw(st.integers(1, 3)))]
        return f"{draw(st.sampled_from('.~|+'))}({' '.join(parts)})"

    return made(3)


@given(texts(), st.lists(st.integers(-3, 3), min_size=40, max_size=40))
def test_the_best_branch_is_the_best_of_all(text: str, values: list[int]) -> None:
    term = algebra.parse(text)

    def worth(part: algebra.Term) -> int:
        return sum(values[task] for task in tasks(part))

    best = best_branch(term, lambda task: values[task])
    everyone = list(branches(term))
    assert best in everyone
    assert best == max(everyone, key=worth)


def of(text: str, *late: Change, count: int = 4) -> Mission:
    from dataclasses import replace

    basis = load(EXAMPLE)
    return replace(basis, tasks=basis.tasks[:count], relations=text, changes=late)


@pytest.mark.parametrize(
    ("text", "done", "accepted", "wanted"),
    [
        ("", (), (), (1, 2, 3, 4)),
        ("", (1,), (1,), (1, 2, 3, 4)),
        ("|(p1 p2 p3 p4)", (1,), (1,), (1, 2, 3, 4)),
        ("+(.(p1 p2) .(p3 p4))", (), (3, 4), (3, 4)),
        ("+(.(p1 p2) .(p3 p4))", (3,), (1, 2), (1, 2)),
        ("+(.(p1 p2) .(p3 p4))", (3, 4), (1, 2), (3, 4)),
        ("+(.(p1 p2) .(p3 p4))", (), (), (1, 2)),
        ("|(+(p1 p2) +(p3 p4))", (2,), (2, 3), (2, 3)),
    ],
)
def test_what_was_accepted_only_tells_the_branch(
    text: str, done: tuple[int, ...], accepted: tuple[int, ...], wanted: tuple[int, ...]
) -> None:
    assert set(asked(of(text), set(done), set(accepted))) == set(wanted)


@pytest.mark.parametrize("text", ["", "|(p1 p2 p3 p4)"])
def test_late_tasks_are_asked_for_and_removed_ones_are_not(text: str) -> None:
    mission = of(
        text,
        Change(60_000, changes.TASK_REMOVED, task=4),
        Change(90_000, changes.TASK_ADDED, task=3),
    )

    def wanted(now_ms: int, done: tuple[int, ...] = ()) -> list[int]:
        return sorted(asked(asked_by(mission, now_ms, done), set(done), {1}))

    assert wanted(0) == [1, 2, 3, 4]
    assert wanted(60_000) == [1, 2, 3]
    assert wanted(60_000, (4,)) == [1, 2, 3, 4]
    assert [t.id for t in known_at(mission, 60_000).tasks] == [1, 2]
    assert asked(of("", count=0), set(), set()) == ()


def test_what_was_said_last_counts() -> None:
    mission = of(
        "",
        Change(80_000, changes.VEHICLE_JOINS, vehicle=2),
        Change(20_000, changes.VEHICLE_LOST, vehicle=2),
        Change(20_000, changes.TASK_REMOVED, task=1),
        Change(80_000, changes.TASK_ADDED, task=1),
        Change(50_000, changes.TASK_ADDED, task=2),
        Change(90_000, changes.TASK_REMOVED, task=2),
    )
    at = [known_at(mission, ms) for ms in (0, 20_000, 50_000, 80_000, 90_000)]
    assert [[v.id for v in m.vehicles] for m in at] == [[1, 2], [1], [1], [1, 2], [1, 2]]
    assert [[t.id for t in m.tasks] for m in at] == [
        [1, 3, 4], [3, 4], [2, 3, 4], [1, 2, 3, 4], [1, 3, 4],
    ]  # fmt: skip
    # between its removal and its next request nobody asks for it, in the end somebody does
    assert 1 in asked(asked_by(mission, 20_000), set(), set())
