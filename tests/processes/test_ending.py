"""How a flight in processes ends: complete, failed, at its limit, or in the declared safe state."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.processes import ending
from cratous.services.processes.ending import Ending

SAFE_MS = 60_000


def plan(**tasks: int) -> Any:
    """Vehicle of each task, named p1, p2..."""
    items = [
        SimpleNamespace(vehicle_id=vehicle, task_id=int(name[1:]), partial=False)
        for name, vehicle in tasks.items()
    ]
    return SimpleNamespace(items=items)


@pytest.fixture
def flight(monkeypatch: pytest.MonkeyPatch) -> Ending:
    monkeypatch.setattr(ending, "in_part_of", lambda plan: ())
    return Ending(plan(p1=1, p2=2), SAFE_MS)


def alone(vehicle: int, mode: str, time_ms: int) -> Any:
    return lmcp.new("LinkLossState", VehicleID=vehicle, Mode=mode, Time=time_ms)


def owner(vehicle: int, name: str) -> Any:
    return lmcp.new("AuthorityChange", VehicleID=vehicle, Owner=name)


def done(task: int) -> Any:
    return lmcp.new("TaskComplete", TaskID=task)


def test_it_is_complete_with_all_tasks_and_nobody_away(flight: Ending) -> None:
    flight.heard(done(1))
    flight.heard(owner(2, "ICAROUS"))
    flight.heard(done(2))
    assert flight.outcome(1000, late=False) == ""
    assert flight.outcome(1000, late=True) == "limit"
    flight.heard(owner(2, "UxAS"))
    assert flight.outcome(1000, late=False) == "complete"


def test_the_safe_state_waits_for_those_that_work_and_for_its_time(flight: Ending) -> None:
    flight.heard(owner(2, "ICAROUS"))
    flight.heard(alone(2, "Loiter", 30_000))
    assert flight.outcome(200_000, late=False) == "", "vehicle 1 has a task"
    flight.heard(done(1))
    assert flight.outcome(89_999, late=False) == ""
    assert flight.outcome(90_000, late=False) == "safe state"
    assert flight.why(2, "safe state", 90_000) == (
        "not served when the flight ended in the declared safe state; "
        "vehicle 2 circles without the link since 30.00 s"
    )
    assert flight.why(2, "limit", 90_000) == "not served when the flight ended (limit)"


def test_one_that_is_away_and_does_not_circle_is_waited_for(flight: Ending) -> None:
    for vehicle in (1, 2):
        flight.heard(owner(vehicle, "ICAROUS"))
    flight.heard(alone(2, "Loiter", 30_000))
    assert flight.outcome(200_000, late=False) == ""
    flight.heard(alone(1, "Finish", 100_000))
    assert flight.outcome(200_000, late=False) == "", "it does not circle"
    flight.heard(alone(1, "Loiter", 100_000))
    assert flight.outcome(159_999, late=False) == ""
    assert flight.outcome(160_000, late=False) == "safe state"


def test_a_link_that_comes_back_begins_the_time_anew(flight: Ending) -> None:
    flight.heard(done(1))
    flight.heard(alone(2, "Loiter", 30_000))
    flight.heard(alone(2, "Linked", 80_000))
    assert flight.outcome(95_000, late=False) == ""
    flight.heard(alone(2, "Loiter", 100_000))
    assert flight.outcome(159_999, late=False) == ""
    assert flight.outcome(160_000, late=False) == "safe state", "held by UxAS's own command"


def test_whose_icarous_is_not_heard_is_known(flight: Ending) -> None:
    for vehicle, alive in ((1, True), (1, False), (2, False), (2, True)):
        flight.heard(lmcp.new("BridgeStatus", VehicleID=vehicle, Alive=alive))
    assert flight.unheard == {1}


def test_one_that_returns_without_the_link_is_waited_for(flight: Ending) -> None:
    flight.heard(done(1))
    flight.heard(done(2))
    flight.heard(alone(1, "Loiter", 10_000))
    flight.heard(alone(2, "Return", 10_000))
    assert flight.outcome(100_000, late=False) == ""
    flight.heard(alone(2, "Over", 100_000))
    assert flight.outcome(159_999, late=False) == ""
    assert flight.outcome(160_000, late=False) == "safe state"


def test_a_vehicle_that_circles_ends_in_the_safe_state_also_without_a_task_left(
    flight: Ending,
) -> None:
    flight.heard(done(1))
    flight.heard(done(2))
    flight.heard(alone(2, "Loiter", 30_000))
    assert flight.outcome(40_000, late=False) == ""
    assert flight.outcome(90_000, late=False) == "safe state"


def test_a_task_that_uxas_fails_by_name_keeps_its_reason(flight: Ending) -> None:
    info = [
        lmcp.new("KeyValuePair", Key=key, Value=value)
        for key, value in (("TaskID", "2"), ("reason", "no way"))
    ]
    flight.heard(lmcp.new("ServiceStatus", Info=info))
    flight.heard(done(1))
    assert flight.outcome(1000, late=False) == "failed"
    assert flight.why(2, "failed", 1000) == "no way"


def test_the_kernel_decides(flight: Ending, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, int, int, int]] = []

    def no(working: int, away: int, safe: int, expected: int) -> bool:
        asked.append((working, away, safe, expected))
        return False

    monkeypatch.setattr(ending, "ends_in_safe_state", no)
    flight.heard(done(1))
    flight.heard(alone(2, "Loiter", 30_000))
    assert flight.outcome(90_000, late=False) == ""
    assert asked == [(0, 1, 1, 0)]
