"""Where the cameras look while a task is flown, as payload states and as ground targets."""

from __future__ import annotations

import math
from typing import Any

from cratous.bridge import lmcp
from cratous.core.following import Track
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.commands import location
from cratous.services.flight.dynamics import AirState, clamp, wrap
from cratous.services.frames import Projection
from cratous.services.sensor import footprint
from cratous.spec.mission import Frame, Position, Task, TaskKind, Vehicle


def target_of(chain: Chain, task: Task | None) -> Position | None:
    """The ground point to look at: on the line, as far along it as the path is flown."""
    if task is None or chain.phase is not Phase.TASK or not task.points:
        return None
    if task.kind is TaskKind.LINE_SEARCH:
        line = Track(task.points)
        return line.at(line.length_m * chain.served())
    if task.kind is TaskKind.POINT_SEARCH:
        return task.points[0]
    return None


def camera_states(
    vehicle: Vehicle,
    state: AirState,
    target: Position | None,
    projection: Projection,
    frame: Frame,
) -> list[Any]:
    """One `CameraState` per camera, angles in degrees, with its footprint if it looks at one."""
    states = []
    for camera in vehicle.cameras:
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
