"""A task's service in each of the nine states of `spec.contracts.tasks`: asked anew, and removed.

Two silent services stand where the sensor manager and the route planner do, so that a task waits for
their answers until the test gives them.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, place, vehicle

from cratous.bridge import lmcp
from cratous.services.pipeline.task_state import State
from cratous.spec.contracts import tasks as table

TASKS = "Task services"
NAME = "CmasiPointSearchTaskService[5]"
SILENT = ("SensorManagerService", "RoutePlannerVisibilityService")


class Silent:
    """A service that hears and says nothing."""

    subscribes: tuple[str, ...] = ()

    def __init__(self, name: str) -> None:
        self.name = name

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Any, now_ms: int) -> tuple[None, Iterable[Any]]:
        return None, ()


def search(number: int = 5) -> Any:
    return lmcp.new(
        "PointSearchTask", TaskID=number, SearchLocation=place(0.02), EligibleEntities=[1]
    )


def unique(number: int) -> Any:
    asked = lmcp.new("AutomationRequest", EntityList=[1, 2], TaskList=[5])
    return lmcp.new("UniqueAutomationRequest", RequestID=number, OriginalRequest=asked)


class Case(Rig):
    """A rig whose task is brought to a state, one message after the other."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "TaskManagerService")
        for name in SILENT:
            self.bus.add(Silent(name))
        self.tell(*vehicle(1), *vehicle(2, 0.01), search())

    @property
    def state(self) -> State:
        found: State = self.bus.state(NAME)
        return found

    def sensors(self, *seen: int) -> None:
        """Footprints for the newest question, of these vehicles."""
        asked = self.got("SensorFootprintRequests")[-1]
        made = [lmcp.new("SensorFootprint", VehicleID=v) for v in seen]
        self.tell(lmcp.new("SensorFootprintResponse", ResponseID=asked.RequestID, Footprints=made))

    def planner(self, missing: tuple[int, ...] = ()) -> None:
        """Routes for the newest question."""
        asked = self.got("RoutePlanRequest")[-1]
        why = [lmcp.new("KeyValuePair", Key="reason", Value="a wall")]
        points = [lmcp.new("Waypoint", Number=n, Latitude=0.001 * n) for n in (1, 2)]
        plans = [
            lmcp.new("RoutePlan", RouteID=c.RouteID, RouteCost=-1, RouteError=why)
            if c.RouteID in missing
            else lmcp.new("RoutePlan", RouteID=c.RouteID, RouteCost=9, Waypoints=points)
            for c in asked.RouteRequests
        ]
        self.tell(
            lmcp.new(
                "RoutePlanResponse",
                ResponseID=asked.RequestID,
                AssociatedTaskID=5,
                VehicleID=asked.VehicleID,
                RouteResponses=plans,
            )
        )

    def choose(self, number: int) -> None:
        """An assignment takes the first option."""
        offered = self.got("TaskPlanOptions")[-1]
        self.tell(
            lmcp.new(
                "TaskImplementationRequest",
                CorrespondingAutomationRequestID=number,
                RequestID=1,
                VehicleID=1,
                TaskID=5,
                OptionID=offered.Options[0].OptionID,
                StartPosition=place(0.0),
            )
        )

    def fly(self, *tasks: int) -> None:
        self.tell(vehicle(1)[1].copy(AssociatedTasks=list(tasks)))

    def plan(self, number: int) -> None:
        """From the request to the plan."""
        self.sensors(1)
        self.planner()
        self.choose(number)
        self.planner()

    def bring(self, to: int) -> None:
        """From IDLE to a state, for request 7."""
        steps = (
            lambda: self.tell(unique(7)),
            lambda: self.sensors(1),
            self.planner,
            lambda: self.choose(7),
            self.planner,
            lambda: self.fly(5),
        )
        for step in steps[: max(0, to - table.IDLE)]:
            step()
        assert self.state.task.state == to


WAITING = (
    table.IDLE,
    table.SENSOR_REQUEST,
    table.OPTION_ROUTES,
    table.OPTIONS_PUBLISHED,
    table.FINAL_ROUTES,
    table.OPTION_SELECTED,
    table.ACTIVE,
)
"""The states in which a task waits for a message; Init and Completed are passed within one."""


@pytest.mark.shows(TASKS, "SensorFootprintRequests", "SensorFootprintResponse", "RoutePlanRequest")
@pytest.mark.parametrize("at", WAITING)
def test_a_new_request_is_answered_in_every_state(tmp_path: Path, at: int) -> None:
    rig = Case(tmp_path)
    rig.bring(at)
    said = len(rig.got("TaskImplementationResponse"))
    rig.tell(unique(8))
    assert rig.state.number(rig.state.task.request) == 8
    assert rig.state.task.state == table.SENSOR_REQUEST
    rig.plan(8)
    made = rig.got("TaskImplementationResponse")[said:]
    assert [b.CorrespondingAutomationRequestID for b in made] == [8]
    # who was steered says that the old plan is over, nobody else does
    undone = ["task 5 ends undone: its plan was withdrawn or overridden"]
    assert rig.reasons("Warning") == (undone if at == table.ACTIVE else [])


@pytest.mark.parametrize("at", WAITING)
def test_a_task_that_is_removed_ends_in_every_state(tmp_path: Path, at: int) -> None:
    rig = Case(tmp_path)
    rig.bring(at)
    rig.tell(lmcp.new("RemoveTasks", TaskList=[5]))
    assert NAME not in rig.bus.names()
    undone = ["task 5 ends undone: it was removed"]
    assert rig.reasons("Warning") == (undone if at in (table.OPTION_SELECTED, table.ACTIVE) else [])
    rig.tell(unique(8))
    assert len(rig.got("KillService")) == 1
    assert not [b for b in rig.got("TaskPlanOptions") if b.CorrespondingAutomationRequestID == 8]
    rig.tell(search())  # and may come again
    rig.tell(unique(9))
    rig.plan(9)
    assert rig.got("TaskImplementationResponse")[-1].CorrespondingAutomationRequestID == 9


@pytest.mark.parametrize("at", [table.INIT, table.COMPLETED])
def test_a_request_is_kept_while_a_task_begins_or_ends(tmp_path: Path, at: int) -> None:
    """Init and Completed are left in the step in which they are entered: the state is set by hand."""
    rig = Case(tmp_path)
    task = rig.bus._services[NAME]
    state = rig.state._replace(task=rig.state.task._replace(state=at))
    rig.tell(unique(7), unique(8))  # so that they mean something
    state, out = task._requested(state, unique(8))
    assert (state.task.state, list(out)) == (at, [])
    assert state.number(state.task.kept) == 8
    event = table.INITIALISED if at == table.INIT else table.PROCEED
    state, out = task._advance(state, event, state.task.request, unique(8))
    assert state.task.state == table.SENSOR_REQUEST
    assert state.number(state.task.request) == 8


@pytest.mark.parametrize("at", [table.SENSOR_REQUEST, table.OPTION_ROUTES])
def test_late_answers_to_an_older_request_change_nothing(tmp_path: Path, at: int) -> None:
    rig = Case(tmp_path)
    rig.bring(at)
    late = rig.got("SensorFootprintRequests" if at == table.SENSOR_REQUEST else "RoutePlanRequest")
    rig.tell(unique(8))
    if at == table.OPTION_ROUTES:
        rig.sensors(1)
    before = rig.state
    if at == table.SENSOR_REQUEST:
        body = lmcp.new("SensorFootprintResponse", ResponseID=late[0].RequestID)
    else:
        body = lmcp.new(
            "RoutePlanResponse", ResponseID=late[0].RequestID, AssociatedTaskID=5, VehicleID=1
        )
    rig.tell(body)
    assert rig.state == before


def test_what_sensors_do_not_see_and_no_route_leads_past_is_not_offered(tmp_path: Path) -> None:
    rig = Case(tmp_path)
    rig.tell(search().copy(EligibleEntities=[]))
    rig.tell(unique(7))
    rig.sensors(2)
    asked = rig.got("RoutePlanRequest")
    assert [a.VehicleID for a in asked] == [2]
    gone = asked[0].RouteRequests[0].RouteID
    rig.planner((gone,))
    (offered,) = rig.got("TaskPlanOptions")
    numbers = [o.OptionID for o in offered.Options]
    assert numbers == [c.RouteID for c in asked[0].RouteRequests if c.RouteID != gone]
    assert {v for o in offered.Options for v in o.EligibleEntities} == {2}
    assert rig.reasons("Warning") == [
        "vehicle 1 is not offered for task 5: no footprint of its sensors came",
        f"option {gone} of task 5 is not offered: a wall",
    ]


def test_the_real_services_answer_and_a_plan_comes(tmp_path: Path) -> None:
    services = (
        "TaskManagerService", "AutomationRequestValidatorService", "SensorManagerService",
        "RoutePlannerVisibilityService", "RouteAggregatorService",
        "AssignmentTreeBranchBoundService", "PlanBuilderService",
    )  # fmt: skip
    rig = Rig(tmp_path, *services)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), search())
    rig.tell(lmcp.new("AutomationRequest", EntityList=[1, 2], TaskList=[5]))
    kinds = rig.kinds()
    order = ["SensorFootprintRequests", "SensorFootprintResponse", "RoutePlanRequest",
             "RoutePlanResponse", "TaskPlanOptions", "AutomationResponse"]  # fmt: skip
    assert [kinds.index(kind) for kind in order] == sorted(kinds.index(kind) for kind in order)
    assert rig.got("AutomationResponse")[0].MissionCommandList
    assert not rig.reasons()
    assert not rig.reasons("Warning")
