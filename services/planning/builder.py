"""PlanBuilderService: has each assigned task turned into waypoints and puts the plan together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.assignment import START, Placed
from cratous.services.bus import Envelope
from cratous.services.frames import compass
from cratous.services.planning import stages
from cratous.services.planning.desk import Desk, Inputs
from cratous.spec.plan import Plan


class Building(NamedTuple):
    """One request: what is assigned, how many are implemented, and waypoints by vehicle."""

    summary: Any
    at: int
    waypoints: dict[int, tuple[Any, ...]]
    finals: dict[int, Any]


class Built(NamedTuple):
    """Requests in work, finished plans by request id, and the last command id."""

    work: dict[int, Building]
    plans: dict[int, Plan]
    commands: int


class PlanBuilderService:
    """TaskAssignmentSummary -> TaskImplementationRequests, in order -> UniqueAutomationResponse."""

    name = "PlanBuilderService"
    subscribes: tuple[str, ...] = (
        "uxas.messages.task.TaskAssignmentSummary",
        "uxas.messages.task.TaskImplementationResponse",
    )

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> Built:
        return Built({}, {}, 0)

    def handle(self, state: Built, envelope: Envelope, now_ms: int) -> tuple[Built, Iterable[Any]]:
        body = envelope.body
        key = body.CorrespondingAutomationRequestID
        if envelope.topic == "uxas.messages.task.TaskAssignmentSummary":
            work = Building(body, 0, {}, {})
        else:
            if key not in state.work:
                return state, ()
            old = state.work[key]
            vehicle = body.VehicleID
            points = (*old.waypoints.get(vehicle, ()), *body.TaskWaypoints)
            work = Building(
                old.summary,
                old.at + 1,
                {**old.waypoints, vehicle: points},
                {**old.finals, vehicle: body},
            )
        if work.at < len(work.summary.TaskList):
            return state._replace(work={**state.work, key: work}), [self._ask(key, work)]
        return self._finish(state, key, work)

    def _ask(self, key: int, work: Building) -> Any:
        inputs = self._desk.inputs(key)
        task = work.summary.TaskList[work.at]
        vehicle = task.AssignedVehicle
        last = work.finals.get(vehicle)
        pose = inputs.starts[vehicle]
        return lmcp.new(
            "TaskImplementationRequest",
            RequestID=work.at + 1,
            CorrespondingAutomationRequestID=key,
            StartingWaypointID=len(work.waypoints.get(vehicle, ())) + 1,
            VehicleID=vehicle,
            StartPosition=last.FinalLocation if last else self._desk.location(pose),
            StartHeading=last.FinalHeading if last else compass(pose.heading_rad),
            StartTime=last.FinalTime if last else inputs.now_ms,
            TaskID=task.TaskID,
            OptionID=task.OptionID,
            TimeThreshold=task.TimeThreshold,
        )

    def _finish(self, state: Built, key: int, work: Building) -> tuple[Built, Iterable[Any]]:
        inputs = self._desk.inputs(key)
        plan = _plan(inputs, work.summary)
        commands, finals = [], []
        for count, (vehicle, points) in enumerate(sorted(work.waypoints.items())):
            last = points[-1].copy(NextWaypoint=points[-1].Number)
            first_view = next((a for w in points for a in w.VehicleActionList if _points(a)), None)
            commands.append(
                lmcp.new(
                    "MissionCommand",
                    CommandID=state.commands + count + 1,
                    VehicleID=vehicle,
                    VehicleActionList=[first_view] if first_view is not None else [],
                    WaypointList=[*points[:-1], last],
                    FirstWaypoint=1,
                )
            )
            final = work.finals[vehicle]
            finals.append(
                lmcp.new(
                    "PlanningState",
                    EntityID=vehicle,
                    PlanningPosition=final.FinalLocation,
                    PlanningHeading=final.FinalHeading,
                )
            )
        response = lmcp.new(
            "UniqueAutomationResponse",
            ResponseID=key,
            OriginalResponse=lmcp.new("AutomationResponse", MissionCommandList=commands),
            FinalStates=finals,
        )
        left = {k: v for k, v in state.work.items() if k != key}
        made = Built(left, {**state.plans, key: plan}, state.commands + len(commands))
        return made, [response]


def _points(action: Any) -> bool:
    return bool(action.type_name == "CMASI/GimbalAngleAction")


def _plan(inputs: Inputs, summary: Any) -> Plan:
    """The plan in the mission frame: times from the summary, ways and constraints from the desk."""
    assert inputs.assigned is not None
    free = {vehicle.id: inputs.now_ms for vehicle in inputs.mission.vehicles}
    at: dict[int, int] = {}
    placed = []
    for task in summary.TaskList:
        vehicle = task.AssignedVehicle
        v, k = inputs.vehicle_index[vehicle], inputs.index[task.TaskID, task.OptionID]
        travel = inputs.routes.travel_ms(v, at.get(vehicle, START), k)
        assert travel is not None
        start = task.TimeTaskCompleted - inputs.options[k].duration_ms
        placed.append(
            Placed(v, k, free[vehicle], free[vehicle] + travel, start, task.TimeTaskCompleted)
        )
        free[vehicle], at[vehicle] = task.TimeTaskCompleted, k
    return stages.build(
        inputs.mission,
        inputs.options,
        inputs.routes,
        replace(inputs.assigned, placed=tuple(placed)),
        inputs.zones,
        inputs.fixed,
    )
