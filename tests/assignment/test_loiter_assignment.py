"""LoiterAssignmentService: whoever assigns, vehicles wait where order and timing ask for it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import cost, matrix, option, options, unique
from pipeline_tools import PIPELINE, Rig, must_fly, place, request, vehicle

from cratous.bridge import lmcp

LOITER = "LoiterAssignmentService"
WAY_MS, TASK_MS = 500_000, 10_000


def summary(number: int, *parts: tuple[int, int, int]) -> Any:
    """(vehicle, task, threshold) of each part."""
    made = [
        lmcp.new("TaskAssignment", AssignedVehicle=v, TaskID=task, OptionID=1, TimeThreshold=at)
        for v, task, at in parts
    ]
    return lmcp.new("TaskAssignmentSummary", CorrespondingAutomationRequestID=number, TaskList=made)


def response(number: int, **held_ms: int) -> Any:
    """Plans of vehicles 1 and 2 with one waypoint a task; held_ms: loiters of the plan, `t6=...`."""
    commands = []
    for v, task in ((1, 5), (2, 6)):
        held = held_ms.get(f"t{task}", 0)
        loiter = lmcp.new("LoiterAction", Duration=held, AssociatedTaskList=[task])
        point = lmcp.new(
            "Waypoint", Number=10 + task, AssociatedTasks=[task],
            VehicleActionList=[loiter] if held else [],
        )  # fmt: skip
        commands.append(lmcp.new("MissionCommand", VehicleID=v, WaypointList=[point]))
    answer = lmcp.new("AutomationResponse", MissionCommandList=commands)
    return lmcp.new("UniqueAutomationResponse", ResponseID=number, OriginalResponse=answer)


def assigned(
    folder: Path, relations: str, *parts: tuple[int, int, int], after: tuple[Any, ...] = ()
) -> Rig:
    """Task 5 is far from vehicle 1, task 6 near vehicle 2; somebody has assigned them."""
    rig = Rig(folder, LOITER)
    rig.tell(
        *vehicle(1), *vehicle(2, 0.01), must_fly(5), must_fly(6),
        unique(2, 5, 6, vehicles=(1, 2), TaskRelationships=relations),
        options(2, 5, option(5, 1, 1, cost=TASK_MS)),
        options(2, 6, option(6, 1, 2, cost=TASK_MS)),
        matrix(2, cost(1, 5, 1, WAY_MS), cost(2, 6, 1, 1_000)),
        summary(2, *(parts or ((1, 5, 0), (2, 6, 0)))),
        *after,
    )  # fmt: skip
    return rig


@pytest.mark.shows(LOITER, "UniqueAutomationRequest", "TaskPlanOptions", "AssignmentCostMatrix")
@pytest.mark.shows(LOITER, "TaskAssignmentSummary", "UniqueAutomationResponse")
@pytest.mark.shows(LOITER, "VehicleActionCommand", "ServiceStatus")
def test_order_is_waited_for_though_the_assignment_says_nothing_of_it(tmp_path: Path) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", after=(response(2),))
    (told,) = rig.got("ServiceStatus")
    assert [pair.Value for pair in told.Info if pair.Key == "loiter"] == [
        "vehicle 2 waits 509.000 s before task 6, from 1.000 s"
    ]
    assert rig.got("VehicleActionCommand") == []
    rig.wait(999)
    assert rig.got("VehicleActionCommand") == []
    rig.wait(1)
    (command,) = rig.got("VehicleActionCommand")
    (action,) = command.VehicleActionList
    assert (command.VehicleID, action.Duration) == (2, WAY_MS + TASK_MS - 1_000)
    laps = action.Duration / 1000 * action.Airspeed / (2 * 3.141592653589793 * action.Radius)
    assert laps == pytest.approx(round(laps), abs=1e-9)
    assert round(laps) >= 1
    rig.wait(action.Duration - 1)
    assert len(rig.got("VehicleActionCommand")) == 1
    rig.wait(1)
    (go,) = rig.got("VehicleActionCommand")[1].VehicleActionList
    assert (go.type_name, go.WaypointNumber) == ("CMASI/GoToWaypointAction", 16)
    rig.wait(2_000_000)
    assert len(rig.got("VehicleActionCommand")) == 2


def test_without_order_or_threshold_nobody_waits(tmp_path: Path) -> None:
    rig = assigned(tmp_path, "|(p5 p6)", after=(response(2),))
    rig.wait(2_000_000)
    assert rig.got("VehicleActionCommand") == []
    assert rig.got("ServiceStatus") == []


def test_an_assigned_start_is_kept(tmp_path: Path) -> None:
    rig = assigned(tmp_path, "|(p5 p6)", (1, 5, 0), (2, 6, 201_000), after=(response(2),))
    rig.wait(300_000)
    first, second = rig.got("VehicleActionCommand")
    assert first.VehicleActionList[0].Duration == 200_000
    assert second.CommandID != first.CommandID


@pytest.mark.parametrize(("held", "said"), [(509_000, []), (300_000, ["the plan waits 300.000 s"])])
def test_a_plan_that_loiters_itself_is_not_told_again(
    tmp_path: Path, held: int, said: list[str]
) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", after=(response(2, t6=held),))
    rig.wait(2_000_000)
    assert rig.got("VehicleActionCommand") == []
    assert [text.rpartition(", but ")[2] for text in rig.reasons()] == said


def test_a_new_plan_voids_what_was_still_to_be_sent(tmp_path: Path) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", after=(response(2),))
    rig.tell(unique(3, 5, 6, vehicles=(1, 2), TaskRelationships="|(p5 p6)"), response(3))
    rig.wait(2_000_000)
    assert rig.got("VehicleActionCommand") == []


def test_what_is_not_flown_voids_nothing(tmp_path: Path) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", after=(response(2),))
    rig.tell(unique(3, 5, 6, vehicles=(1, 2)).copy(SandBoxRequest=True), response(3))
    rig.wait(2_000_000)
    assert len(rig.got("VehicleActionCommand")) == 2


@pytest.mark.parametrize(
    ("relations", "parts", "words"),
    [
        ("|(p5 p6_[0-5000])", (), "p6_[0-5000]"),
        (".(p6 p5)_[0-20000]", (), "_[0-20000]"),
        ("|(p5 p6)", ((1, 5, 0), (1, 5, 0)), "no branch of the relations"),
        ("|(p5 p6)", ((1, 5, 0), (3, 6, 0)), "an assignment of what is not there"),
        ("|(p5 p6)", ((1, 5, 0), (1, 6, 0)), "not eligible"),
        (".(p5 p6)", ((1, 5, 0), (2, 6, -5)), "TimeThreshold"),
        (".(p5 p6)", ((1, 5, 0), (2, 6, 2**62)), "TimeThreshold"),
    ],
)
def test_an_assignment_without_times_ends_its_request(
    tmp_path: Path, relations: str, parts: tuple[tuple[int, int, int], ...], words: str
) -> None:
    rig = assigned(tmp_path, relations, *parts, after=(response(2),))
    rig.wait(2_000_000)
    (text,) = rig.reasons()
    assert words in text
    assert rig.got("VehicleActionCommand") == []
    assert rig.bus.state(LOITER).work == {}


def test_an_assignment_of_a_part_that_the_relations_permit_is_one(tmp_path: Path) -> None:
    rig = assigned(tmp_path, "|(p5 p6)", (1, 5, 0), after=(response(2),))
    rig.wait(2_000_000)
    assert rig.reasons() == []
    assert rig.bus.state(LOITER).work == {}


def test_an_assignment_of_what_must_wait_for_what_is_left_out_ends_its_request(
    tmp_path: Path,
) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", (2, 6, 0), after=(response(2),))
    rig.wait(2_000_000)
    (text,) = rig.reasons()
    assert "no branch of the relations" in text


def test_an_assignment_before_its_costs_is_an_error(tmp_path: Path) -> None:
    rig = Rig(tmp_path, LOITER)
    rig.tell(*vehicle(1), must_fly(5), unique(2, 5, vehicles=(1,)), summary(2, (1, 5, 0)))
    assert "an assignment came before its costs" in rig.reasons()[0]


def test_in_our_pipeline_the_plan_has_every_loiter(tmp_path: Path) -> None:
    """The service finds the very waits that assignment and tasks have put into the plan."""
    rig = Rig(tmp_path, *PIPELINE, LOITER)
    asked = request(5, 6, vehicles=(1, 2), TaskRelationships=".(p5 p6)-[120000-900000]")
    rig.tell(*vehicle(1), *vehicle(2, 0.01), must_fly(5, 0.02), must_fly(6, 0.03), asked)
    rig.wait(2_000_000)
    loiters = [
        pair.Value for b in rig.got("ServiceStatus") for pair in b.Info if pair.Key == "loiter"
    ]
    (answer,) = rig.got("AutomationResponse")
    held = [
        action.Duration
        for command in answer.MissionCommandList
        for point in command.WaypointList
        for action in point.VehicleActionList
        if action.type_name == "CMASI/LoiterAction"
    ]
    assert len(loiters) == len(held) == 1
    assert f"waits {held[0] / 1000:.3f} s before task 6" in loiters[0]
    assert rig.got("VehicleActionCommand") == []
    assert rig.reasons() == []


def test_places_are_degrees(tmp_path: Path) -> None:
    rig = assigned(tmp_path, ".(p5 p6)", after=(response(2),))
    rig.wait(1_000)
    (command,) = rig.got("VehicleActionCommand")
    there = command.VehicleActionList[0].Location
    assert abs(there.Latitude - place(0.02).Latitude) < 0.1
    assert there.Altitude == 300.0
