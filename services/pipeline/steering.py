"""Camera commands of a task's service: where to look, sent with each state of the vehicle that flies it.

Lines and points are stared at; over an area the gimbal holds the angles for which the option was planned.
Planned and commanded views thus come from one source (`planning.targets`).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.loading.coordinates import Places
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.coordinates import read_pose
from cratous.services.planning.options import Option
from cratous.services.planning.performance_classes import camera_for
from cratous.services.planning.targets import Angles, flown_view, target_from
from cratous.spec.mission import AREAS, SEARCHES, Camera, Position, Task
from cratous.spec.mission.plan import Pose


class Steering(NamedTuple):
    """A task being flown: its option, camera and frame."""

    task: Task
    option: Option
    camera: Camera
    places: Places
    projection: Projection


def steering_of(context: Context, task: Task, option: Option) -> Steering | None:
    """The camera steering for an option; None if there is nothing to look at, or no camera."""
    camera = camera_for(task, option.flyer.cameras)
    if task.kind not in SEARCHES or camera is None:
        return None
    frame = context.inputs.mission.frame
    return Steering(task, option, camera, Places(frame), context.places.projection)


def look_command(steering: Steering, state: Any) -> Any:
    """The VehicleActionCommand for a vehicle in a state (an EntityState); BadInput if its position is
    invalid.
    """
    where = f"state of vehicle {state.ID}"
    here = read_pose(state.Location, state.Heading, steering.places, where, "Location")
    return _looking_from(steering, here, state.ID)


def last_look(steering: Steering, vehicle: int) -> Any:
    """The VehicleActionCommand for a vehicle whose task is reported complete: the look from the end of the
    path.

    An autopilot that turns short counts the end as reached up to two turn radii before it.
    """
    return _looking_from(steering, steering.option.end, vehicle)


def _looking_from(steering: Steering, here: Pose, vehicle: int) -> Any:
    option = steering.option
    made_for = Angles(option.view_elevation_rad, option.view_azimuth_rad)
    if steering.task.kind in AREAS and made_for.elevation_rad is not None:
        look = _held(steering, made_for, made_for.elevation_rad, here.heading_rad)
    else:
        look = _stare(steering, made_for, here)
    return lmcp.new("VehicleActionCommand", VehicleID=vehicle, VehicleActionList=[look])


def _held(steering: Steering, made_for: Angles, elevation_rad: float, heading_rad: float) -> Any:
    """The angles of the option's view; inertial ones are converted to relative ones with the heading."""
    view = flown_view(steering.task, made_for, steering.option.flyer.cameras)
    north_rad = heading_rad if view is not None and view.inertial else 0.0
    azimuth_rad = math.remainder(made_for.azimuth_rad - north_rad, 2 * math.pi)
    return lmcp.new(
        "GimbalAngleAction",
        AssociatedTaskList=[steering.task.id],
        PayloadID=steering.camera.payload_id,
        Azimuth=math.degrees(azimuth_rad),
        Elevation=math.degrees(elevation_rad),
    )


def _stare(steering: Steering, made_for: Angles, here: Pose) -> Any:
    """The point that planning has the camera look at from here."""
    task, cameras = steering.task, steering.option.flyer.cameras
    terrain_m, place = steering.places.terrain_m, Position(*here[:3])
    target = target_from(place, here.heading_rad, task, made_for, cameras, terrain_m)
    assert target is not None
    latitude, longitude = steering.projection.to_geodetic(target.north_m, target.east_m)
    return lmcp.new(
        "GimbalStareAction",
        AssociatedTaskList=[task.id],
        PayloadID=steering.camera.payload_id,
        Starepoint=lmcp.new(
            "Location3D", Latitude=latitude, Longitude=longitude, Altitude=target.alt_m
        ),
    )
