"""Services of tasks: made and removed, active and complete, their options and implementations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import ended, planned, unique
from pipeline_tools import Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp

TASKS = "Task services"


def to_be_implemented(option: int, of: int = 1) -> Any:
    """A request that task 5 be implemented by vehicle 1; of: which automation request."""
    return lmcp.new(
        "TaskImplementationRequest",
        CorrespondingAutomationRequestID=of,
        VehicleID=1,
        TaskID=5,
        OptionID=option,
        StartPosition=place(0.0),
    )


@pytest.mark.shows(
    "TaskManagerService",
    "Task",
    "RemoveTasks",
    "CreateNewService",
    "KillService",
    "EntityState",
    "EntityConfiguration",
)
@pytest.mark.shows(TASKS, "TaskInitialized")
def test_a_task_has_a_service_until_it_is_removed(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), must_fly(5))
    (made,) = rig.got("CreateNewService")
    assert [s.ID for s in made.EntityStates] == [1]
    assert [c.ID for c in made.EntityConfigurations] == [1]
    assert [b.TaskID for b in rig.got("TaskInitialized")] == [5]
    rig.tell(must_fly(5, 0.03))
    assert [b.ServiceID for b in rig.got("KillService")] == [made.ServiceID]
    assert [n for n in rig.bus.names() if "[5]" in n] == ["MustFlyTaskService[5]"]
    rig.tell(lmcp.new("RemoveTasks", TaskList=[5, 9]))
    assert not [n for n in rig.bus.names() if "[5]" in n]


def flying(number: int, *tasks: int, time: int = 0) -> Any:
    return vehicle(number)[1].copy(AssociatedTasks=list(tasks), Time=time)


@pytest.mark.shows(TASKS, "EntityState", "TaskActive", "TaskComplete")
def test_a_task_is_active_while_a_vehicle_says_so_and_completes_after(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), loiter(5), request(5))
    assert rig.got("AutomationResponse")[0].MissionCommandList
    rig.tell(flying(2, 5, time=10), flying(1, time=20))
    assert not rig.got("TaskActive")  # another vehicle, and not yet
    rig.tell(flying(1, 5, time=30), flying(1, 5, time=40))
    assert [(b.EntityID, b.TimeTaskActivated) for b in rig.got("TaskActive")] == [(1, 30)]
    rig.tell(flying(1, time=50), flying(1, time=60))
    (done,) = rig.got("TaskComplete")
    assert (done.TaskID, done.EntitiesInvolved, done.TimeTaskCompleted) == (5, [1], 50)
    rig.tell(request(5))
    assert rig.got("AutomationResponse")[1].MissionCommandList


@pytest.mark.shows(TASKS, "AuthorityChange")
def test_a_takeover_completes_no_task(tmp_path: Path) -> None:
    """While ICAROUS flies a vehicle, and until it flies waypoints again, its states list no task."""

    def owner(name: str, number: int = 1) -> Any:
        return lmcp.new("AuthorityChange", VehicleID=number, Owner=name)

    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), loiter(5), request(5))
    rig.tell(flying(1, 5, time=10), owner("ICAROUS", 2), flying(1, 5, time=20))
    rig.tell(owner("ICAROUS"), flying(1, time=30), owner("UxAS"))
    rig.tell(flying(1, time=40).copy(Mode="FlightDirector"), flying(1, 5, time=50))
    assert not rig.got("TaskComplete")
    rig.tell(flying(1, time=60))
    assert [b.TimeTaskCompleted for b in rig.got("TaskComplete")] == [60]


@pytest.mark.shows(TASKS, "LinkLossState")
def test_a_circle_without_the_link_completes_no_task(tmp_path: Path) -> None:
    def alone(mode: str, number: int = 1) -> Any:
        return lmcp.new("LinkLossState", VehicleID=number, Mode=mode)

    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), loiter(5), request(5))
    rig.tell(flying(1, 5, time=10), alone("Loiter", 2), alone("Finish"), flying(1, 5, time=20))
    rig.tell(alone("Loiter"), flying(1, time=30).copy(Mode="Loiter"), alone("Linked"))
    rig.tell(flying(1, time=40).copy(Mode="Loiter"), flying(1, 5, time=50))
    assert not rig.got("TaskComplete")
    rig.tell(flying(1, time=60))
    assert [b.TimeTaskCompleted for b in rig.got("TaskComplete")] == [60]


@pytest.mark.shows(TASKS, "AutomationResponse", "ServiceStatus")
def test_a_task_whose_plan_is_withdrawn_says_that_it_ends_undone(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), loiter(5), loiter(6, 0.03), request(5))
    rig.tell(flying(1, 5), request(6))
    assert not rig.got("TaskComplete")
    assert rig.reasons("Warning") == ["task 5 ends undone: its plan was withdrawn or overridden"]
    rig.tell(request(5))
    assert len(rig.got("AutomationResponse")[2].MissionCommandList) == 1


def test_an_active_task_that_is_asked_again_ends_and_answers_the_new_request(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), loiter(5), request(5))
    rig.tell(flying(1, 5))
    rig.tell(request(5))
    assert [len(b.MissionCommandList) for b in rig.got("AutomationResponse")] == [1, 1]
    assert rig.reasons("Warning") == ["task 5 ends undone: its plan was withdrawn or overridden"]


@pytest.mark.shows(
    TASKS,
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "TaskImplementationRequest",
    "RoutePlanRequest",
    "RoutePlanResponse",
    "TaskImplementationResponse",
)
def test_a_task_answers_only_its_own_request_and_options(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService", "AutomationRequestValidatorService")
    rig.tell(*vehicle(1), loiter(5), request(5))
    (offered,) = rig.got("TaskPlanOptions")
    numbers = [o.OptionID for o in offered.Options]
    assert offered.Composition == "+(" + " ".join(f"p{n}" for n in numbers) + ")"
    asked = to_be_implemented(numbers[0], of=9).copy(RequestID=1)
    rig.tell(asked)
    assert not rig.got("RoutePlanRequest")
    mine = asked.copy(CorrespondingAutomationRequestID=1)
    rig.tell(mine)
    (route,) = rig.got("RoutePlanRequest")
    first = next(o for o in offered.Options if o.OptionID == numbers[0])
    assert route.RouteRequests[0].EndLocation == first.StartLocation
    points = [lmcp.new("Waypoint", Number=n, Latitude=0.001 * n) for n in (1, 2)]
    plan = lmcp.new("RoutePlan", RouteID=1, RouteCost=5_000, Waypoints=points)
    answer = planned(route).copy(AssociatedTaskID=5, RouteResponses=[plan])
    rig.tell(answer.copy(ResponseID=route.RequestID + 1))
    assert not rig.got("TaskImplementationResponse")
    rig.tell(answer)
    (made,) = rig.got("TaskImplementationResponse")
    assert (made.TaskID, made.VehicleID, made.FinalTime) == (5, 1, 5_000 + first.Cost)
    assert made.FinalLocation == first.EndLocation
    assert [w.Number for w in made.TaskWaypoints] == list(range(len(made.TaskWaypoints)))


@pytest.mark.shows(TASKS, "UniqueAutomationResponse", "ServiceStatus")
@pytest.mark.parametrize("end", ["response", "error"])
def test_a_task_lets_a_request_go_that_has_ended(tmp_path: Path, end: str) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), loiter(5))
    rig.tell(unique(1, 5))
    (offered,) = rig.got("TaskPlanOptions")
    asked = to_be_implemented(offered.Options[0].OptionID)
    ending = lmcp.new("UniqueAutomationResponse", ResponseID=1) if end == "response" else ended(1)
    rig.tell(ending, asked)
    assert not rig.got("RoutePlanRequest")
    rig.tell(unique(2, 5), asked.copy(CorrespondingAutomationRequestID=2, OptionID=999))
    assert len(rig.got("TaskPlanOptions")) == 2
    assert not rig.got("RoutePlanRequest")
    assert "task 5 has no such option" in rig.reasons()[0]


def test_an_option_is_flown_by_nobody_for_whom_it_is_not(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), *vehicle(2), loiter(5))
    rig.tell(unique(1, 5), to_be_implemented(1).copy(VehicleID=2))
    (said,) = rig.reasons()
    assert "task 5 has no such option for vehicle 2" in said
    assert not rig.got("RoutePlanRequest")
    rig.tell(unique(2, 5))
    assert len(rig.got("TaskPlanOptions")) == 2, "the task's service goes on"


def test_a_route_that_is_not_there_is_an_error_with_its_reason(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), loiter(5))
    rig.tell(unique(1, 5))
    rig.tell(to_be_implemented(1))
    (route,) = rig.got("RoutePlanRequest")
    why = [lmcp.new("KeyValuePair", Key="reason", Value="a wall")]
    plan = lmcp.new("RoutePlan", RouteID=1, RouteCost=-1, RouteError=why)
    rig.tell(planned(route).copy(AssociatedTaskID=5, RouteResponses=[plan]))
    assert rig.reasons() == ["vehicle 1 has no way to task 5: a wall"]
    assert not rig.got("TaskImplementationResponse")
