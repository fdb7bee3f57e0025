"""The plan builder alone: tasks of an assignment are implemented in turn and answered once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import ended, implementation, unique
from pipeline_tools import Rig, must_fly, place, request, vehicle

from cratous.bridge import lmcp

BUILDER = "PlanBuilderService"


def summary(number: int, *assigned: tuple[int, int]) -> Any:
    return lmcp.new(
        "TaskAssignmentSummary",
        CorrespondingAutomationRequestID=number,
        TaskList=[
            lmcp.new("TaskAssignment", TaskID=t, OptionID=1, AssignedVehicle=v) for t, v in assigned
        ],
    )


def implemented(asked: Any, *waypoints: int, latitude: float = 0.5) -> Any:
    points = [
        lmcp.new("Waypoint", Number=n, NextWaypoint=n + 1, AssociatedTasks=[asked.TaskID])
        for n in waypoints
    ]
    end = place(latitude)
    return implementation(asked, points, FinalLocation=end, FinalHeading=45.0, FinalTime=9_000)


@pytest.mark.shows(
    BUILDER,
    "UniqueAutomationRequest",
    "TaskAssignmentSummary",
    "TaskImplementationRequest",
    "TaskImplementationResponse",
    "UniqueAutomationResponse",
    "EntityState",
)
def test_tasks_are_implemented_in_assignment_order_and_answered_once(tmp_path: Path) -> None:
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), unique(4, 5, 6, 7, vehicles=(1, 2)))
    rig.tell(summary(4, (5, 1), (6, 2), (7, 1)))
    (first,) = rig.got("TaskImplementationRequest")
    assert (first.TaskID, first.VehicleID, first.StartPosition) == (5, 1, place(0.0))
    ahead = first.copy(TaskID=7)
    rig.tell(implemented(ahead, 1))  # not its turn
    assert len(rig.got("TaskImplementationRequest")) == 1
    assert "out of turn" in rig.reasons("Warning")[0]
    rig.tell(implemented(first, 1, 2), implemented(first, 1, 2))
    second = rig.got("TaskImplementationRequest")[1]
    assert (second.TaskID, second.VehicleID) == (6, 2)
    assert len(rig.got("TaskImplementationRequest")) == 2
    rig.tell(implemented(second, 1))
    third = rig.got("TaskImplementationRequest")[2]
    # from where and when the vehicle's task before ends, numbered on
    assert (third.StartPosition, third.StartHeading, third.StartTime) == (place(0.5), 45.0, 9_000)
    assert third.StartingWaypointID == 3
    assert not rig.got("UniqueAutomationResponse")
    rig.tell(implemented(third, 3, 4), implemented(third, 3, 4), summary(4, (5, 1)))
    (response,) = rig.got("UniqueAutomationResponse")
    assert response.ResponseID == 4
    one, two = response.OriginalResponse.MissionCommandList
    assert [(w.Number, w.NextWaypoint, w.AssociatedTasks) for w in one.WaypointList] == [
        (1, 2, [5]), (2, 3, [5]), (3, 4, [7]), (4, 5, [7]), (5, 5, [])
    ]  # fmt: skip
    assert [w.Number for w in two.WaypointList] == [1, 2]
    assert [s.EntityID for s in response.FinalStates] == [1, 2]
    assert rig.bus.state(BUILDER).work == {}


@pytest.mark.shows(BUILDER, "ServiceStatus")
def test_an_empty_assignment_or_implementation_is_answered_with_an_error(tmp_path: Path) -> None:
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*vehicle(1), unique(4, 5), summary(4), unique(6, 5), summary(6, (5, 1)))
    (asked,) = rig.got("TaskImplementationRequest")
    rig.tell(implemented(asked), summary(77, (5, 1)))
    assert rig.reasons() == [
        "the assignment has no task",
        "task 5 was implemented without waypoints or end",
    ]
    assert "TaskAssignmentSummary of a request that is not" in rig.reasons("Warning")[0]
    rig.tell(unique(8, 5), ended(8), summary(8, (5, 1)))
    assert len(rig.got("TaskImplementationRequest")) == 1
    assert not rig.got("UniqueAutomationResponse")


def test_the_end_is_a_waypoint_without_a_task_of_which_there_is_one(tmp_path: Path) -> None:
    """Whoever's task it was: numbers stay apart, and an end that bears no task stays the end."""
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*vehicle(1), unique(4, 5), summary(4, (5, 1)), unique(6, 5), summary(6, (5, 1)))
    one, two = (implemented(asked, 9, 2) for asked in rig.got("TaskImplementationRequest"))
    ends = [point.copy(NextWaypoint=0) for point in one.TaskWaypoints]
    rig.tell(one.copy(TaskWaypoints=ends))
    free = two.TaskWaypoints[-1].copy(AssociatedTasks=[])
    rig.tell(two.copy(TaskWaypoints=[two.TaskWaypoints[0], free]))
    added, kept = (
        body.OriginalResponse.MissionCommandList[0].WaypointList
        for body in rig.got("UniqueAutomationResponse")
    )
    assert [(w.Number, w.AssociatedTasks) for w in added] == [(9, [5]), (2, [5]), (10, [])]
    assert [w.NextWaypoint for w in added[1:]] == [10, 10]
    assert [(w.Number, w.NextWaypoint) for w in kept] == [(9, 10), (2, 2)]


@pytest.mark.shows(BUILDER, "AddLoiterToEndOfMission", "DefaultLoiterRadius_m", "TurnType")
def test_the_end_is_loitered_at_and_turns_are_flown_over_if_asked(tmp_path: Path) -> None:
    text = 'AddLoiterToEndOfMission="TRUE" DefaultLoiterRadius_m="250" TurnType="FlyOver"'
    rig = Rig(tmp_path, BUILDER, **{BUILDER: text})
    rig.tell(*vehicle(1), unique(4, 5), summary(4, (5, 1)))
    rig.tell(implemented(rig.got("TaskImplementationRequest")[0], 1, 2))
    (command,) = rig.got("UniqueAutomationResponse")[0].OriginalResponse.MissionCommandList
    assert {w.TurnType.name for w in command.WaypointList} == {"FlyOver"}
    assert [len(w.VehicleActionList) for w in command.WaypointList] == [0, 0, 1]
    loiter_action = command.WaypointList[-1].VehicleActionList[0]
    assert (loiter_action.Radius, loiter_action.Duration) == (250.0, -1)


@pytest.mark.shows(BUILDER, "AssignmentStartPointLead_m")
def test_a_plan_may_begin_ahead_of_where_a_vehicle_is_unless_a_zone_lies_there(
    tmp_path: Path,
) -> None:
    box = lmcp.new("Rectangle", CenterPoint=place(0.002), Width=60.0, Height=60.0)
    zone = lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box)
    rig = Rig(tmp_path, **{BUILDER: 'AssignmentStartPointLead_m="400"'})
    rig.tell(*vehicle(1), zone, lmcp.new("OperatingRegion", ID=3, KeepOutAreas=[8]), must_fly(5))
    for region in (0, 3):
        rig.tell(request(5, OperatingRegion=region))
    free, bound = (u.PlanningStates[0].PlanningPosition for u in rig.got("UniqueAutomationRequest"))
    assert free.Latitude == pytest.approx(400 / 110_574, rel=1e-3)
    assert bound.Latitude == pytest.approx(0.0, abs=1e-9)
    first = rig.got("AutomationResponse")[0].MissionCommandList[0].WaypointList[0]
    assert first.Latitude == pytest.approx(free.Latitude, abs=1e-7)
    assert all(r.MissionCommandList for r in rig.got("AutomationResponse"))
