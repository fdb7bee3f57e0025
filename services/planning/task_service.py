"""One service per task: offers its options, and turns the chosen one into waypoints."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.frames import compass
from cratous.services.planning.desk import Desk
from cratous.services.planning.flyers import camera_for
from cratous.services.planning.options import Option
from cratous.services.planning.stages import hold_of
from cratous.services.sensor import zoomed
from cratous.spec.mission import Camera, Task, TaskKind
from cratous.spec.plan import Hold

NAMES = {
    TaskKind.LINE_SEARCH: "CmasiLineSearchTaskService",
    TaskKind.POINT_SEARCH: "CmasiPointSearchTaskService",
    TaskKind.MUST_FLY: "MustFlyTaskService",
    TaskKind.LOITER: "LoiterTaskService",
    TaskKind.AREA_SEARCH: "CmasiAreaSearchTaskService",
    TaskKind.PATTERN_SEARCH: "PatternSearchTaskService",
}

Pending = dict[tuple[int, int], Any]
"""Implementation requests that wait for their route, by (request id, request of the route)."""


class TaskService:
    """UniqueAutomationRequest -> TaskPlanOptions; TaskImplementationRequest -> ...Response.

    In between an implementation asks the route planner for the way to the task's start.
    """

    subscribes: tuple[str, ...] = (
        "uxas.messages.task.UniqueAutomationRequest",
        "uxas.messages.task.TaskImplementationRequest",
        "uxas.messages.route.RoutePlanResponse",
    )

    def __init__(self, desk: Desk, task: Task) -> None:
        self._desk, self._task = desk, task
        self.name = f"{NAMES[task.kind]}[{task.id}]"

    def start(self) -> Pending:
        return {}

    def handle(
        self, state: Pending, envelope: Envelope, now_ms: int
    ) -> tuple[Pending, Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "uxas.messages.task.UniqueAutomationRequest":
            if self._task.id in body.OriginalRequest.TaskList:
                options = self._desk.inputs(body.RequestID).options_of(self._task.id)
                return state, [self._offer(body.RequestID, options)]
            return state, ()
        if envelope.topic == "uxas.messages.task.TaskImplementationRequest":
            if body.TaskID != self._task.id:
                return state, ()
            return {**state, (body.VehicleID, body.RequestID): body}, [self._ask_route(body)]
        key = (body.VehicleID, body.ResponseID)
        if body.AssociatedTaskID != self._task.id or key not in state:
            return state, ()
        rest = {k: v for k, v in state.items() if k != key}
        return rest, [self._implement(state[key], body)]

    def _offer(self, request_id: int, options: Sequence[Option]) -> Any:
        numbers = " ".join(f"p{option.option_id}" for option in options)
        return lmcp.new(
            "TaskPlanOptions",
            CorrespondingAutomationRequestID=request_id,
            TaskID=self._task.id,
            Composition=f"+({numbers})" if options else "",
            Options=[self._message(option) for option in options],
        )

    def _message(self, option: Option) -> Any:
        return lmcp.new(
            "TaskOption",
            TaskID=option.task_id,
            OptionID=option.option_id,
            EligibleEntities=list(option.vehicles),
            Cost=option.duration_ms,
            StartLocation=self._desk.location(option.start),
            StartHeading=compass(option.start.heading_rad),
            EndLocation=self._desk.location(option.end),
            EndHeading=compass(option.end.heading_rad),
        )

    def _option(self, request: Any) -> Option:
        inputs = self._desk.inputs(request.CorrespondingAutomationRequestID)
        return inputs.options[inputs.index[request.TaskID, request.OptionID]]

    def _ask_route(self, request: Any) -> Any:
        option = self._option(request)
        route = lmcp.new(
            "RouteConstraints",
            RouteID=1,
            StartLocation=request.StartPosition,
            StartHeading=request.StartHeading,
            EndLocation=self._desk.location(option.start),
            EndHeading=compass(option.start.heading_rad),
        )
        return lmcp.new(
            "RoutePlanRequest",
            RequestID=request.RequestID,
            AssociatedTaskID=self._task.id,
            VehicleID=request.VehicleID,
            RouteRequests=[route],
            IsCostOnlyRequest=False,
        )

    def _implement(self, request: Any, response: Any) -> Any:
        """The waypoints of the way there, the hold if there is a wait, and the task itself."""
        inputs = self._desk.inputs(request.CorrespondingAutomationRequestID)
        option, route = self._option(request), response.RouteResponses[0]
        first, speed = request.StartingWaypointID, option.flyer.speed_m_s
        # copies of the planner's waypoints, renumbered: a published object is a value
        points = [
            w.copy(Number=first + k, NextWaypoint=first + k + 1)
            for k, w in enumerate(route.Waypoints[:-1])
        ]
        start = first + len(points)
        mine = self._desk.waypoints(option.path, start, speed, [self._task.id])
        arrive = request.StartTime + route.RouteCost
        wait = max(0, request.TimeThreshold - arrive)
        actions: list[Any] = []
        if option.view_elevation_rad is not None:
            camera = camera_for(self._task, option.flyer.cameras)
            actions.append(
                lmcp.new(
                    "GimbalAngleAction",
                    AssociatedTaskList=[self._task.id],
                    PayloadID=camera.payload_id if camera else 0,
                    Azimuth=math.degrees(option.view_azimuth_rad),
                    Elevation=math.degrees(option.view_elevation_rad),
                )
            )
            actions += self._zoom(camera, option, inputs.mission.frame.terrain_m)
        hold = hold_of(option, wait, inputs.zones) if wait > 0 else None
        if hold is not None:
            actions.append(self._loiter(hold, wait, speed))
        mine[0].VehicleActionList = actions
        return lmcp.new(
            "TaskImplementationResponse",
            ResponseID=request.RequestID,
            CorrespondingAutomationRequestID=request.CorrespondingAutomationRequestID,
            TaskID=self._task.id,
            OptionID=request.OptionID,
            VehicleID=request.VehicleID,
            TaskWaypoints=points + mine,
            FinalLocation=self._desk.location(option.end),
            FinalHeading=compass(option.end.heading_rad),
            FinalTime=arrive + wait + option.duration_ms,
        )

    def _zoom(self, camera: Camera | None, option: Option, terrain_m: float) -> list[Any]:
        """The camera's field of view, if the task asks for another than the present one."""
        if camera is None:
            return []
        narrow = zoomed(camera, self._task, option.flyer.alt_m - terrain_m)
        if narrow == camera:
            return []
        return [
            lmcp.new(
                "CameraAction",
                AssociatedTaskList=[self._task.id],
                PayloadID=camera.camera_id,
                HorizontalFieldOfView=math.degrees(narrow.hfov_rad),
            )
        ]

    def _loiter(self, hold: Hold, wait_ms: int, speed_m_s: float) -> Any:
        centre = self._desk.projection.to_geodetic(hold.north_m, hold.east_m)
        return lmcp.new(
            "LoiterAction",
            AssociatedTaskList=[self._task.id],
            LoiterType="Circular",
            Radius=hold.radius_m,
            Direction="Clockwise" if hold.clockwise else "CounterClockwise",
            Duration=wait_ms,
            Airspeed=speed_m_s,
            Location=lmcp.new(
                "Location3D", Latitude=centre[0], Longitude=centre[1], Altitude=hold.alt_m
            ),
        )
