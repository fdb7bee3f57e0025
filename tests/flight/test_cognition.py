"""The decision logic of ICAROUS: one mode at a time, which says why the vehicle flies as it does and decides what it flies."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from flight_tools import flown, meeting, of_type
from ground_tools import assert_in_the_guide
from mission_tools import must_fly

from cratous.bridge import lmcp
from cratous.core.authority import cognition as kernels
from cratous.core.authority.cognition import Conditions, decide, resolution
from cratous.services.flight import legs
from cratous.services.icarous import cognition as logic
from cratous.services.icarous import instance
from cratous.services.loading import load
from cratous.spec.authority import cognition as meant
from cratous.spec.mission import Position

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"
ALL = [Conditions(*seen) for seen in product((False, True), repeat=len(Conditions._fields))]


def modes(log: list[Any], vehicle: int = 1) -> list[str]:
    """The modes that a vehicle went through, each once."""
    told = [b.Mode.name for b in of_type(log, "CognitionState") if b.VehicleID == vehicle]
    return [one for k, one in enumerate(told) if k == 0 or told[k - 1] != one]


@cache
def met() -> tuple[Any, list[Any]]:
    """A flight with one conflict, and its log."""
    return flown(meeting())


def test_the_names_are_those_of_the_specification() -> None:
    body: Any = lmcp.new("CognitionState")
    for field in ("Mode", "Resolution"):
        for one in type(getattr(body, field)):
            words = "".join(f"_{c}" if c.isupper() else c for c in one.name)[1:].upper()
            assert getattr(meant, words.replace("NO_RESOLUTION", "NONE")) == int(one)
    assert {name.capitalize() for name in Conditions._fields} <= set(dir(body))


def test_the_gravest_mode_with_a_reason_is_flown() -> None:
    for mode in (meant.NOMINAL, meant.TRAFFIC_CONFLICT, meant.LAND, meant.LANDED):
        for seen in ALL:
            found = [m for m in range(13) if meant.has_reason(m, mode, meant.Conditions(*seen))]
            assert decide(mode, seen) == max(found)


@pytest.mark.parametrize(
    ("flown_by", "found"),
    [((1, 0, 0, 1), meant.TURN), ((0, 1, 0, 1), meant.ALTITUDE), ((0, 0, 1, 1), meant.SPEED),
     ((1, 1, 0, 1), meant.COMBINED), ((1, 0, 1, 1), meant.COMBINED), ((1, 0, 0, 0), meant.LEAST_BAD)],
)  # fmt: skip
def test_how_a_conflict_is_avoided(flown_by: tuple[int, ...], found: int) -> None:
    told = [bool(one) for one in flown_by]
    assert resolution(meant.TRAFFIC_CONFLICT, *told) == found
    assert resolution(meant.FENCE_CONFLICT, *told) == found
    assert resolution(meant.RETURN_TO_PATH, *told) == meant.NONE


def test_each_mode_in_the_log_is_the_kernel_s() -> None:
    result, log = met()
    assert result.outcome == "complete"
    assert modes(log) == ["TrafficConflict", "ReturnToPath", "Nominal"]
    before, states = kernels.NOMINAL, of_type(log, "CognitionState")
    assert len(states) > 3
    for body in states:
        seen = Conditions(*(getattr(body, name.capitalize()) for name in Conditions._fields))
        before = decide(before, seen)
        assert int(body.Mode) == before
    taken = of_type(log, "AuthorityChange")[0]
    first = states[0]
    assert (first.Time, first.IntruderID) == (taken.Time, taken.IntruderID)
    assert first.Resolution.name == "Turn"
    assert all(b.Mode.name in ("Nominal", "Deviation") or b.Has or b is first for b in states)


def test_without_the_machine_nothing_is_avoided(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is flown follows from the mode: in one that is always nominal ICAROUS takes nothing over."""
    monkeypatch.setattr(logic, "decide", lambda mode, seen: kernels.NOMINAL)
    result, log = flown(meeting())
    assert result.takeovers == 0
    assert modes(log) in ([], ["Nominal"])


def test_a_mode_that_never_goes_back_keeps_the_vehicle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(instance, "mode_lets_go", lambda mode: False)
    mission = meeting()
    limit = replace(mission.simulation, limit_ms=60_000)
    back = of_type(met()[1], "AuthorityChange")[-1]
    assert (back.Owner.name, back.Time < limit.limit_ms) == ("UxAS", True)
    _, log = flown(replace(mission, simulation=limit))
    assert of_type(log, "AuthorityChange")[-1].Owner.name == "ICAROUS"


def test_a_goal_that_is_blocked_is_left_out_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """A drone hovers over the first of two goals: the leg is given up, the next waypoint is flown to."""
    monkeypatch.setattr(legs, "LONGEST_LOOKAHEADS", 0.5)
    mission = load(MISSION)
    (drone,) = mission.traffic
    over = replace(drone, position=Position(1500.0, 0.0, 300.0))
    second = must_fly(2, (0.0, -2500.0, 300.0))
    tasks = (mission.tasks[0], second)
    result, log = flown(replace(mission, traffic=(over,), tasks=tasks, relations="|(p1 p2)"))
    assert modes(log) == ["TrafficConflict", "NextWaypoint", "Nominal"]
    skips = [b for b in of_type(log, "CognitionState") if b.Mode.name == "NextWaypoint"]
    assert all(b.Skips and b.Skipped > 0 for b in skips)
    assert result.failed[1].startswith("blocked: ")
    assert list(result.ends) == [2]
    assert result.outcome == "failed"


def test_the_diagram_in_the_guide_is_the_kernel_s(root: Path) -> None:
    assert_in_the_guide(root, "cognition_machine.py")
