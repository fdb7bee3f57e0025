"""What the executive does with tasks is what its kernels answer, in the air too."""

from __future__ import annotations

from dataclasses import replace

import pytest
from flight_tools import flown, meeting, of_type, with_deadline

from cratous.bridge import lmcp
from cratous.services.flight import executive, loop, touched
from cratous.services.flight.lives import life
from cratous.services.flight.touched import touched_by
from cratous.spec.executive import BEGUN, COMPLETE, ENDED, FAILED, GIVE_UP, LEFT, STANDS_BY
from cratous.spec.mission import Change, Mission, Simulation
from cratous.spec.mission.changes import (
    TASK_ADDED,
    TASK_REMOVED,
    VEHICLE_JOINS,
    VEHICLE_LOST,
    WIND,
)


def alone(limit_ms: int = 400_000) -> Mission:
    """One vehicle, one task, no traffic."""
    return replace(meeting(), traffic=(), simulation=Simulation(limit_ms=limit_ms))


@pytest.mark.parametrize(
    ("ended", "failed", "expected"),
    [((), (), LEFT), ((7,), (), ENDED), ((), (7,), FAILED), ((8,), (8,), LEFT)],
)
def test_what_has_become_of_a_task(
    ended: tuple[int, ...], failed: tuple[int, ...], expected: int
) -> None:
    assert life(7, (8,), ended, failed) == expected
    assert life(7, (7,), ended, failed) == (BEGUN if expected == LEFT else expected)


def test_no_task_begins_that_may_not(monkeypatch: pytest.MonkeyPatch) -> None:
    result, log = flown(alone())
    assert result.outcome == "complete"
    begun = result.starts[1]
    monkeypatch.setattr(executive, "may_begin", lambda *_: False)
    result, log = flown(alone(begun + 60_000))
    assert (result.outcome, result.starts, result.ends) == ("limit", {}, {})
    phases = [p.Phase.name for p in of_type(log, "TaskProgress", TaskID=1)]
    assert phases == ["Transit", "Waiting"]


@pytest.mark.parametrize(("act", "failed"), [(GIVE_UP, [1]), (STANDS_BY, [])])
def test_the_kernel_says_what_a_missed_deadline_leads_to(
    monkeypatch: pytest.MonkeyPatch, act: int, failed: list[int]
) -> None:
    mission, plan = with_deadline()
    result, _ = flown(mission, plan)
    assert (result.replans, list(result.failed)) == (1, [])
    monkeypatch.setattr(executive, "late_act", lambda *_: act)
    result, _ = flown(mission, plan)
    assert (result.replans, list(result.failed)) == (0, failed)


def test_the_kernel_ends_the_flight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loop, "flight_outcome", lambda *_: COMPLETE)
    result, _ = flown(alone())
    assert (result.outcome, result.end_ms) == ("complete", 0)


def test_a_settled_task_does_not_fail_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A change that leaves no plan fails what is left, once, and by the kernel."""
    lost = Change(5000, VEHICLE_LOST, vehicle=1)
    mission = replace(alone(60_000), changes=(lost,))
    result, log = flown(mission)
    assert list(result.failed) == [1]
    assert len(of_type(log, "TaskProgress", Phase=lmcp.enums["TaskPhase"].Failed)) == 1
    monkeypatch.setattr(executive, "task_after", lambda before, event: before)
    result, _ = flown(mission)
    assert list(result.failed) == []


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (Change(0, VEHICLE_LOST, vehicle=1), ""),
        (Change(0, VEHICLE_JOINS, vehicle=1), "what is left is shared out again"),
        (Change(0, TASK_ADDED, task=1), "what is left is shared out again"),
        (Change(0, TASK_REMOVED, task=1), "task 1 is left out"),
        (Change(0, TASK_REMOVED, task=2), ""),
        (Change(0, WIND), ""),
    ],
)
def test_which_changes_ask_for_another_plan(
    monkeypatch: pytest.MonkeyPatch, change: Change, why: str
) -> None:
    assert touched_by([change], (), {}, {2}, {}) == why
    monkeypatch.setattr(touched, "change_counts", lambda *_: False)
    assert touched_by([change], (), {}, {2}, {}) == ""
