"""PlanBuilderService: assembles a plan in assignment order, driven by the proved `building_step`.

TaskAssignmentSummary -> TaskImplementationRequest, one task after the other, each starting where the one
before ends -> UniqueAutomationResponse, or a ServiceStatus of type Error; exactly one answer.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.contracts.building import Building, building_step
from cratous.services.bus import Envelope
from cratous.services.pipeline.contexts import UNIQUE, Contexts
from cratous.services.pipeline.request_end import ENDINGS, newest, request_ended
from cratous.services.pipeline.status import status

NAME = "PlanBuilderService"
SUMMARY = "uxas.messages.task.TaskAssignmentSummary"
IMPLEMENTED = "uxas.messages.task.TaskImplementationResponse"
ASSIGNED, BUILT, FAILED = 1, 2, 3
ASK, ANSWER, REFUSE, REPORT = 1, 2, 3, 4


class Work(NamedTuple):
    """One request: the kernel's progress, the request, its assignment, waypoints and last response by
    vehicle.
    """

    progress: Building
    request: Any
    parts: tuple[Any, ...]
    waypoints: dict[int, tuple[Any, ...]]
    finals: dict[int, Any]


class Built(NamedTuple):
    """Requests in progress, and the last command id."""

    work: dict[int, Work]
    commands: int = 0


class Options(NamedTuple):
    """turn_type: of all waypoints; loiter_m: radius of a final loiter [m], 0 for none."""

    turn_type: str = "TurnShort"
    loiter_m: float = 0.0


class PlanBuilderService:
    """Assembles plans."""

    name = NAME
    subscribes: tuple[str, ...] = (UNIQUE, SUMMARY, IMPLEMENTED, *ENDINGS)
    knows = ("EntityState",)

    def __init__(self, contexts: Contexts, options: Options = Options()) -> None:
        self._contexts, self._options = contexts, options

    def start(self) -> Built:
        return Built({})

    def handle(self, state: Built, envelope: Envelope, now_ms: int) -> tuple[Built, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            work = Work(Building(0, 0, 0), body, (), {}, {})
            return state._replace(work=newest({**state.work, body.RequestID: work})), ()
        if topic in ENDINGS:
            ended = request_ended(topic, body)
            left = {k: v for k, v in state.work.items() if k != ended}
            return state._replace(work=left), ()
        key = body.CorrespondingAutomationRequestID
        if key not in state.work:
            text = f"{type(body).__name__} of a request that is not being planned"
            return state, [status(0, "Warning", [("reason", text), ("Request", str(key))])]
        if topic == SUMMARY:
            return self._assigned(state, key, body)
        return self._implemented(state, key, body)

    def _assigned(self, state: Built, key: int, body: Any) -> tuple[Built, Iterable[Any]]:
        work = state.work[key]
        progress, act, part, _ = building_step(work.progress, ASSIGNED, len(body.TaskList))
        if act == REPORT:
            return state, [_stale(key, "a second assignment")]
        work = work._replace(progress=progress, parts=tuple(body.TaskList))
        return self._act(state, key, work, act, part, "the assignment has no task")

    def _implemented(self, state: Built, key: int, body: Any) -> tuple[Built, Iterable[Any]]:
        work = state.work[key]
        number = _part(work, body)
        empty = not body.TaskWaypoints or body.FinalLocation is None
        event = FAILED if empty and number == work.progress.at else BUILT
        progress, act, part, done = building_step(work.progress, event, number)
        if act == REPORT:
            return state, [_stale(key, f"an implementation of task {body.TaskID} out of turn")]
        work = work._replace(progress=progress)
        if done:
            vehicle = body.VehicleID
            points = (*work.waypoints.get(vehicle, ()), *body.TaskWaypoints)
            work = work._replace(
                waypoints={**work.waypoints, vehicle: points},
                finals={**work.finals, vehicle: body},
            )
        why = f"task {body.TaskID} was implemented without waypoints or end"
        return self._act(state, key, work, act, part, why)

    def _act(
        self, state: Built, key: int, work: Work, act: int, part: int, why: str
    ) -> tuple[Built, Iterable[Any]]:
        if act == ASK:
            out = self._ask(key, work, part)
            return state._replace(work={**state.work, key: work}), [out]
        left = {k: v for k, v in state.work.items() if k != key}
        if act == REFUSE:
            return state._replace(work=left), [status(key, "Error", [("reason", why)])]
        response = self._finish(state.commands, key, work)
        return Built(left, state.commands + len(work.waypoints)), [response]

    def _ask(self, key: int, work: Work, part: int) -> Any:
        task = work.parts[part]
        vehicle = task.AssignedVehicle
        last = work.finals.get(vehicle)
        if last is None:
            (place, heading), time = self._from(work, vehicle), self._contexts.begin_ms(key)
        else:
            place, heading, time = last.FinalLocation, last.FinalHeading, last.FinalTime
        return lmcp.new(
            "TaskImplementationRequest",
            RequestID=part + 1,
            CorrespondingAutomationRequestID=key,
            StartingWaypointID=len(work.waypoints.get(vehicle, ())) + 1,
            VehicleID=vehicle,
            StartPosition=place,
            StartHeading=heading,
            StartTime=time,
            RegionID=work.request.OriginalRequest.OperatingRegion,
            TaskID=task.TaskID,
            OptionID=task.OptionID,
            TimeThreshold=task.TimeThreshold,
            NeighborLocations=[
                planning for planning in work.request.PlanningStates if planning.EntityID != vehicle
            ],
        )

    def _from(self, work: Work, vehicle: int) -> tuple[Any, float]:
        """Where a vehicle's plan starts: as the request states, else its newest state."""
        for planning in work.request.PlanningStates:
            if planning.EntityID == vehicle:
                return planning.PlanningPosition, planning.PlanningHeading
        state = self._contexts.world.get("state", vehicle)
        return (None, 0.0) if state is None else (state.Location, state.Heading)

    def _finish(self, commands: int, key: int, work: Work) -> Any:
        made, finals = [], []
        for count, (vehicle, points) in enumerate(sorted(work.waypoints.items())):
            first_view = next((a for w in points for a in w.VehicleActionList if _views(a)), None)
            made.append(
                lmcp.new(
                    "MissionCommand",
                    CommandID=commands + count + 1,
                    VehicleID=vehicle,
                    VehicleActionList=[first_view] if first_view is not None else [],
                    WaypointList=self._finished(points),
                    FirstWaypoint=points[0].Number,
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
        return lmcp.new(
            "UniqueAutomationResponse",
            ResponseID=key,
            OriginalResponse=lmcp.new("AutomationResponse", MissionCommandList=made),
            FinalStates=finals,
        )

    def _finished(self, points: tuple[Any, ...]) -> list[Any]:
        """A vehicle's waypoints with the configured turn type; the last is its own successor, or ends in a
        loiter.
        """
        turn = self._options.turn_type
        if points[-1].AssociatedTasks and self._contexts.source.outside is not None:
            points = _released(points)
        turned = [w if w.TurnType.name == turn else w.copy(TurnType=turn) for w in points]
        last = turned[-1].copy(NextWaypoint=turned[-1].Number)
        if self._options.loiter_m:
            place = lmcp.new(
                "Location3D",
                Latitude=last.Latitude,
                Longitude=last.Longitude,
                Altitude=last.Altitude,
                AltitudeType=last.AltitudeType,
            )
            loiter = lmcp.new(
                "LoiterAction",
                LoiterType="Circular",
                Radius=self._options.loiter_m,
                Duration=-1,
                Airspeed=last.Speed,
                Location=place,
            )
            last = last.copy(VehicleActionList=[*last.VehicleActionList, loiter])
        return [*turned[:-1], last]


def _released(points: tuple[Any, ...]) -> tuple[Any, ...]:
    """Add a copy of the last waypoint without tasks: flying to it shows that the last task is complete."""
    last, number = points[-1], 1 + max(w.Number for w in points)
    more = last.copy(Number=number, AssociatedTasks=[], VehicleActionList=[])
    return *points[:-1], last.copy(NextWaypoint=number), more


def _part(work: Work, body: Any) -> int:
    """Index of the part of the assignment that a response belongs to, the requested one first; -1 if none."""
    for k in (work.progress.at, *range(len(work.parts))):
        if k in range(len(work.parts)):
            part = work.parts[k]
            if (part.TaskID, part.AssignedVehicle) == (body.TaskID, body.VehicleID):
                return k
    return -1


def _views(action: Any) -> bool:
    return bool(action.type_name == "CMASI/GimbalAngleAction")


def _stale(key: int, what: str) -> Any:
    return status(0, "Warning", [("reason", f"{what}: nobody waits for it"), ("Request", str(key))])
