"""A task's messages about its options, and the waypoints of the chosen one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import lasted
from cratous.services.mission.sensor import zoomed
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.outside import Outside
from cratous.services.pipeline.status import status
from cratous.services.planning.options import Option
from cratous.services.planning.performance_classes import camera_for
from cratous.services.planning.stages import hold_of
from cratous.services.planning.targets import Angles, flown_view
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Camera, Position, Task
from cratous.spec.mission.plan import Hold

ROUNDED_MS = 50
"""Shorter waits are omitted [ms]. An ICAROUS route has places of six decimals and may be this much shorter
than UxAS's own route, by which the start was planned. The task then begins earlier, which is reported.
"""


def offer(context: Context, task_id: int, options: Sequence[Option]) -> Any:
    """The TaskPlanOptions of a task: a choice of one of its options."""
    numbers = " ".join(f"p{option.option_id}" for option in options)
    return lmcp.new(
        "TaskPlanOptions",
        CorrespondingAutomationRequestID=context.request.RequestID,
        TaskID=task_id,
        Composition=f"+({numbers})" if options else "",
        Options=[_option(context.places, option) for option in options],
    )


def _option(places: RequestPlaces, option: Option) -> Any:
    return lmcp.new(
        "TaskOption",
        TaskID=option.task_id,
        OptionID=option.option_id,
        EligibleEntities=list(option.vehicles),
        Cost=option.duration_ms,
        **places.ends(option.start, option.end),
    )


def way_asked(context: Context, option: Option, request: Any, number: int) -> Any:
    """The RoutePlanRequest for the route to a chosen option, from where the vehicle will be."""
    place, heading_deg = context.places.sent(option.start)
    route = lmcp.new(
        "RouteConstraints",
        RouteID=1,
        StartLocation=request.StartPosition,
        StartHeading=request.StartHeading,
        EndLocation=place,
        EndHeading=heading_deg,
    )
    return lmcp.new(
        "RoutePlanRequest",
        RequestID=number,
        AssociatedTaskID=option.task_id,
        VehicleID=request.VehicleID,
        OperatingRegion=context.region,
        RouteRequests=[route],
        IsCostOnlyRequest=False,
    )


def implemented(
    context: Context, task: Task, option: Option, request: Any, plan: Any, outside: Outside | None
) -> list[Any]:
    """The waypoints of the route (a RoutePlan), a hold if there is a wait, and the task; and a warning if a
    short wait is omitted.

    NoPlan if there is no room to hold.
    """
    places = context.places
    first, speed = request.StartingWaypointID, option.flyer.speed_m_s
    # published objects are values: copies of the planner's waypoints are renumbered
    points = [
        w.copy(Number=first + k, NextWaypoint=first + k + 1)
        for k, w in enumerate(plan.Waypoints[:-1])
    ]
    path = places.spaced(option.path, option.flyer.radius_m, outside)
    mine = places.waypoints(path, first + len(points), speed, [task.id])
    wait = max(0, request.TimeThreshold - request.StartTime - plan.RouteCost)
    holds = lasted(0, wait, ROUNDED_MS)
    hold = hold_of(option, wait, context.inputs.zones) if holds else None
    if holds and hold is None:
        raise NoPlan(
            (
                f"vehicle {request.VehicleID} has to wait {wait / 1000:.3f} s before task "
                f"{task.id}, and no hold circle there obeys the zones",
            )
        )
    actions = _views(task, option, context.inputs.mission.frame.terrain_m)
    if hold is not None:
        actions.append(loiter_action(places, task.id, hold, wait, speed))
    mine[0].VehicleActionList = actions
    mine[0].Speed = context.usual_speed_m_s(request.VehicleID)  # the last leg of the route
    end, heading_deg = places.sent(option.end)
    made = lmcp.new(
        "TaskImplementationResponse",
        ResponseID=request.RequestID,
        CorrespondingAutomationRequestID=request.CorrespondingAutomationRequestID,
        TaskID=task.id,
        OptionID=request.OptionID,
        VehicleID=request.VehicleID,
        TaskWaypoints=points + mine,
        FinalLocation=end,
        FinalHeading=heading_deg,
        FinalTime=request.StartTime + plan.RouteCost + wait + option.duration_ms,
    )
    if holds or wait == 0:
        return [made]
    early = (
        f"vehicle {request.VehicleID} begins task {task.id} {wait / 1000:.3f} s earlier than "
        "planned: its way is so much shorter, and no wait that short is held"
    )
    return [made, status(context.request.RequestID, "Warning", [("reason", early)])]


def _views(task: Task, option: Option, terrain_m: float) -> list[Any]:
    """Camera direction and field of view, if the task requires a view."""
    if option.view_elevation_rad is None:
        return []
    camera = camera_for(task, option.flyer.cameras)
    made_for = Angles(option.view_elevation_rad, option.view_azimuth_rad)
    view = flown_view(task, made_for, option.flyer.cameras)
    # a gimbal azimuth is relative to the heading at the start of the task
    north_rad = option.start.heading_rad if view is not None and view.inertial else 0.0
    azimuth_rad = math.remainder(option.view_azimuth_rad - north_rad, 2 * math.pi)
    look = lmcp.new(
        "GimbalAngleAction",
        AssociatedTaskList=[task.id],
        PayloadID=camera.payload_id if camera else 0,
        Azimuth=math.degrees(azimuth_rad),
        Elevation=math.degrees(option.view_elevation_rad),
    )
    return [look, *_zoom(task, camera, option.flyer.alt_m - terrain_m)]


def _zoom(task: Task, camera: Camera | None, height_m: float) -> list[Any]:
    """The field of view for which the option was made, if the camera has several."""
    if camera is None or not camera.zoom_rad:
        return []
    narrow = zoomed(camera, task, height_m)
    return [
        lmcp.new(
            "CameraAction",
            AssociatedTaskList=[task.id],
            PayloadID=camera.camera_id,
            HorizontalFieldOfView=math.degrees(narrow.hfov_rad),
        )
    ]


def loiter_action(
    places: RequestPlaces, task_id: int, hold: Hold, wait: int, speed_m_s: float
) -> Any:
    """The LoiterAction for a wait [ms] before a task."""
    return lmcp.new(
        "LoiterAction",
        AssociatedTaskList=[task_id],
        LoiterType="Circular",
        Radius=hold.radius_m,
        Direction="Clockwise" if hold.clockwise else "CounterClockwise",
        Duration=wait,
        Airspeed=speed_m_s,
        Location=places.location(Position(hold.north_m, hold.east_m, hold.alt_m)),
    )
