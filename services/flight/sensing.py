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
from cratous.services.sensor import aim, footprint, zoomed
from cratous.spec.mission import AREAS, Frame, Position, Task, TaskKind, Vehicle, View


def target_of(
    chain: Chain, task: Task | None, state: AirState, terrain_m: float
) -> Position | None:
    """The ground point to look at: on the line, as far along it as the path is flown; the point;
    or, over an area, below the aircraft or where the task's view looks."""
    if task is None or chain.phase is not Phase.TASK or not task.points:
        return None
    if task.kind is TaskKind.LINE_SEARCH:
        line = Track(_as_flown(chain, task.points))
        return line.at(line.length_m * chain.served())
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
    wanted = (item.view_elevation_rad, item.view_azimuth_rad)
    views = [view for view in (task.view, *task.views) if view is not None]
    return min(
        views,
        key=lambda v: (
            abs(v.elevation_rad - wanted[0])
            + abs(math.remainder(v.azimuth_rad - wanted[1], 2 * math.pi))
        ),
    )


def _as_flown(chain: Chain, points: tuple[Position, ...]) -> tuple[Position, ...]:
    """A line in the direction in which the chosen path follows it."""
    assert chain.item is not None
    line, path = Track(points), Track(chain.item.path)

    def apart_m(backward: bool) -> float:
        total = 0.0
        for share in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0):
            a = line.at(line.length_m * (1 - share if backward else share))
            b = path.at(path.length_m * share)
            total += math.hypot(a.north_m - b.north_m, a.east_m - b.east_m)
        return total

    return points[::-1] if min((False, True), key=apart_m) else points


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
