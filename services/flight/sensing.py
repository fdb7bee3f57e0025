"""Where the cameras point while a task is flown, as payload states and as ground targets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.commands import location
from cratous.services.flight.dynamics import AirState, clamp, wrap
from cratous.services.mission.frames import Projection
from cratous.services.mission.sensor import footprint
from cratous.services.planning.targets import Angles, flown_camera, target_from
from cratous.spec.mission import Camera, Frame, Mission, Position, Task, Vehicle


class Looks(NamedTuple):
    """payloads: a `CameraState` per camera; tasks: ids of the tasks that they serve."""

    payloads: list[Any]
    tasks: list[int]


def looks(
    vehicle: Vehicle, chain: Chain, state: AirState, mission: Mission, projection: Projection
) -> Looks:
    """Where a vehicle's cameras point; no target while ICAROUS has the vehicle."""
    task = mission.task(chain.item.task_id) if chain.item is not None else None
    frame = mission.frame
    target = None if chain.suspended else target_of(chain, task, state, frame.terrain_m)
    cameras = vehicle.cameras
    if task is not None and target is not None:
        height_m, made_for = vehicle.cruise_alt_m - frame.terrain_m, made_for_of(chain)
        cameras = tuple(flown_camera(one, task, height_m, made_for) for one in cameras)
    payloads = camera_states(cameras, state, target, projection, frame)
    return Looks(payloads, [task.id] if task is not None and target is not None else [])


def target_of(
    chain: Chain, task: Task | None, state: AirState, terrain_m: float
) -> Position | None:
    """The ground point to look at, as the flown option was planned; None while no task is flown."""
    if task is None or chain.phase is not Phase.TASK:
        return None
    cameras, made_for = chain.vehicle.cameras, made_for_of(chain)
    return target_from(state.position, state.heading_rad, task, made_for, cameras, terrain_m)


def made_for_of(chain: Chain) -> Angles:
    """The view for which the flown option was made."""
    item = chain.item
    return (
        Angles(None, 0.0)
        if item is None
        else Angles(item.view_elevation_rad, item.view_azimuth_rad)
    )


def camera_states(
    cameras: Sequence[Camera],
    state: AirState,
    target: Position | None,
    projection: Projection,
    frame: Frame,
) -> list[Any]:
    """One `CameraState` per camera as it is zoomed, angles in degrees, with its footprint if it has a target."""
    states = []
    for camera in cameras:
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
