"""Where the cameras look while a task is flown, as payload states and as ground targets."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.commands import location
from cratous.services.flight.dynamics import AirState, clamp, wrap
from cratous.services.mission.frames import Projection
from cratous.services.mission.sensor import aim, footprint, look_on_line, zoomed
from cratous.services.planning.flyers import camera_for
from cratous.services.planning.point_ways import tilted
from cratous.spec.mission import AREAS, Frame, Mission, Position, Task, TaskKind, Vehicle, View
from cratous.spec.mission.plan import PlanItem


class Looks(NamedTuple):
    """payloads: a `CameraState` per camera; tasks: the ids of those that they look at something for."""

    payloads: list[Any]
    tasks: list[int]


def looks(
    vehicle: Vehicle, chain: Chain, state: AirState, mission: Mission, projection: Projection
) -> Looks:
    """Where a vehicle's cameras look now; at nothing while ICAROUS has the vehicle."""
    task = mission.task(chain.item.task_id) if chain.item is not None else None
    frame = mission.frame
    target = None if chain.suspended else target_of(chain, task, state, frame.terrain_m)
    payloads = camera_states(vehicle, state, target, projection, frame, task)
    return Looks(payloads, [task.id] if task is not None and target is not None else [])


def target_of(
    chain: Chain, task: Task | None, state: AirState, terrain_m: float
) -> Position | None:
    """The ground point to look at: of a line the one nearest to where the flown option's view looks,
    as planning has it; the point; or, over an area, below the aircraft or where the view looks."""
    if task is None or chain.phase is not Phase.TASK or not task.points:
        return None
    if task.kind is TaskKind.LINE_SEARCH:
        height, view = state.position.alt_m - terrain_m, flown_view(chain, task)
        here = (state.position.north_m, state.position.east_m)
        n, e = look_on_line(here, state.heading_rad, task.points, view, height)
        return Position(n, e, terrain_m)
    if task.kind is TaskKind.POINT_SEARCH:
        return task.points[0]
    if task.kind in AREAS:
        p = state.position
        view = chosen_view(chain, task)
        n, e = aim(p.north_m, p.east_m, state.heading_rad, view, p.alt_m - terrain_m)
        return Position(float(n), float(e), terrain_m)
    return None


def chosen_view(chain: Chain, task: Task) -> View | None:
    """The view for which the flown option was made: of several, the one with its elevation."""
    item = chain.item
    if item is None or item.view_elevation_rad is None or not task.views:
        return task.view
    return _nearest(item, (task.view, *task.views))


def flown_view(chain: Chain, task: Task) -> View | None:
    """As `chosen_view`; where the task asks for none, the one that the option has brought itself."""
    asked, item = chosen_view(chain, task), chain.item
    brought = tilted(task, camera_for(task, chain.vehicle.cameras))
    if asked is not None or item is None or item.view_elevation_rad is None or not brought:
        return asked
    return _nearest(item, brought)


def _nearest(item: PlanItem, views: Iterable[View | None]) -> View:
    wanted = (item.view_elevation_rad or 0.0, item.view_azimuth_rad)
    return min(
        (view for view in views if view is not None),
        key=lambda v: (
            abs(v.elevation_rad - wanted[0])
            + abs(math.remainder(v.azimuth_rad - wanted[1], 2 * math.pi))
        ),
    )


def camera_states(
    vehicle: Vehicle,
    state: AirState,
    target: Position | None,
    projection: Projection,
    frame: Frame,
    task: Task | None = None,
) -> list[Any]:
    """One `CameraState` per camera, angles in degrees, with its footprint if it looks at one.

    task: what it looks at the target for; a camera that can zooms in as the task asks.
    """
    states = []
    for wide in vehicle.cameras:
        camera = wide
        if task is not None and target is not None:
            camera = zoomed(wide, task, vehicle.cruise_alt_m - frame.terrain_m)
        azimuth, elevation = 0.0, camera.min_elevation_rad
        corners: list[Any] = []
        if target is not None:
            p = state.position
            north, east = target.north_m - p.north_m, target.east_m - p.east_m
            azimuth = clamp(
                wrap(math.atan2(east, north) - state.heading_rad),
                camera.min_azimuth_rad,
                camera.max_azimuth_rad,
            )
            elevation = clamp(
                -math.atan2(p.alt_m - frame.terrain_m, math.hypot(north, east)),
                camera.min_elevation_rad,
                camera.max_elevation_rad,
            )
            quad = footprint(
                p, state.heading_rad, camera, (target.north_m, target.east_m), frame.terrain_m
            )
            corners = [location(projection, Position(n, e, frame.terrain_m)) for n, e in quad or ()]
        states.append(
            lmcp.new(
                "CameraState",
                PayloadID=camera.payload_id,
                PointingMode="AirVehicleRelativeAngle",
                Azimuth=math.degrees(azimuth),
                Elevation=math.degrees(elevation),
                HorizontalFieldOfView=math.degrees(camera.hfov_rad),
                VerticalFieldOfView=math.degrees(
                    2 * math.atan(math.tan(camera.hfov_rad / 2) / camera.aspect)
                ),
                Footprint=corners,
                Centerpoint=location(projection, target) if corners and target else None,
            )
        )
    return states
