"""Commands to an autopilot as LMCP messages, and their decoding.

A polyline is a `MissionCommand`, a velocity a `VehicleActionCommand` with a `FlightDirectorAction`, a circle
one with a `LoiterAction`. Each travels inside a `GatedCommand` with its sender and epoch.
"""

from __future__ import annotations

import math
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.gate import ICAROUS, UXAS
from cratous.core.avoidance.manoeuvre import velocity_of
from cratous.core.routing.polylines import Track
from cratous.services.flight.autopilot import Circle, Command, Fly, Follow
from cratous.services.mission.frames import Projection, compass
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.plan import Hold

SENDERS = {UXAS: "UxAS", ICAROUS: "ICAROUS"}


def location(projection: Projection, p: Position) -> Any:
    """A position of the mission frame as a `Location3D`."""
    lat, lon = projection.to_geodetic(p.north_m, p.east_m)
    return lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=p.alt_m)


def gated(vehicle_id: int, epoch: int, sender: int, command: Any) -> Any:
    """A command addressed to a vehicle's gate, as a `GatedCommand`."""
    return lmcp.new(
        "GatedCommand", VehicleID=vehicle_id, Epoch=epoch, Sender=SENDERS[sender], Command=command
    )


def path_command(
    projection: Projection,
    vehicle_id: int,
    command_id: int,
    points: tuple[Position, ...],
    speed_m_s: float,
    tasks: tuple[int, ...] = (),
) -> Any:
    """A `MissionCommand` to fly these points in order at a speed [m/s]; the last waypoint is its own
    successor.
    """
    lats, lons = projection.to_geodetic_many(
        [p.north_m for p in points], [p.east_m for p in points]
    )
    waypoints = [
        lmcp.new(
            "Waypoint",
            Latitude=float(lat),
            Longitude=float(lon),
            Altitude=p.alt_m,
            Number=k + 1,
            NextWaypoint=min(k + 2, len(points)),
            Speed=speed_m_s,
            SpeedType="Groundspeed",
            AssociatedTasks=list(tasks),
        )
        for k, (p, lat, lon) in enumerate(zip(points, lats, lons, strict=True))
    ]
    return lmcp.new(
        "MissionCommand",
        CommandID=command_id,
        VehicleID=vehicle_id,
        WaypointList=waypoints,
        FirstWaypoint=1,
    )


def velocity_command(vehicle_id: int, command_id: int, v: Velocity) -> Any:
    """A `VehicleActionCommand` to fly this velocity [m/s]."""
    action = lmcp.new(
        "FlightDirectorAction",
        Speed=math.hypot(v.north_m_s, v.east_m_s),
        SpeedType="Groundspeed",
        Heading=compass(math.atan2(v.east_m_s, v.north_m_s)),
        ClimbRate=-v.down_m_s,
    )
    return lmcp.new(
        "VehicleActionCommand",
        CommandID=command_id,
        VehicleID=vehicle_id,
        VehicleActionList=[action],
    )


def loiter_command(
    projection: Projection, vehicle_id: int, command_id: int, hold: Hold, speed_m_s: float
) -> Any:
    """A command to loiter on a circle at speed_m_s [m/s] until the next command."""
    action = lmcp.new(
        "LoiterAction",
        LoiterType="Circular",
        Radius=hold.radius_m,
        Direction="Clockwise" if hold.clockwise else "CounterClockwise",
        Duration=-1,
        Airspeed=speed_m_s,
        Location=location(projection, Position(hold.north_m, hold.east_m, hold.alt_m)),
    )
    return lmcp.new(
        "VehicleActionCommand",
        CommandID=command_id,
        VehicleID=vehicle_id,
        VehicleActionList=[action],
    )


def decode(projection: Projection, body: Any, heading_rad: float) -> Command:
    """The autopilot command in an LMCP body. heading_rad: present heading. BadInput for an unknown command."""
    if isinstance(body, lmcp.types["MissionCommand"]):
        points = body.WaypointList
        norths, easts = projection.to_local_many(
            [p.Latitude for p in points], [p.Longitude for p in points]
        )
        local = tuple(
            Position(float(n), float(e), p.Altitude)
            for n, e, p in zip(norths, easts, points, strict=True)
        )
        return Follow(Track(local, heading_rad), points[0].Speed)
    for action in body.VehicleActionList:
        if isinstance(action, lmcp.types["FlightDirectorAction"]):
            heading = math.radians(action.Heading)
            return Fly(velocity_of(heading, action.Speed, action.ClimbRate))
        if isinstance(action, lmcp.types["LoiterAction"]):
            where = action.Location
            north, east = projection.to_local(where.Latitude, where.Longitude)
            clockwise = action.Direction.name != "CounterClockwise"
            hold = Hold(north, east, where.Altitude, action.Radius, clockwise)
            return Circle(hold, action.Airspeed)
    raise BadInput(
        "a command that the autopilot does not know",
        item=type(body).__name__,
        expected="MissionCommand, FlightDirectorAction or LoiterAction",
    )


def task_progress(
    task_id: int, vehicle_id: int, at_ms: int, phase: str, served: float, note: str
) -> Any:
    """State of a task as a `TaskProgress`. at_ms: time [ms]; served: flown fraction, 0 to 1."""
    return lmcp.new(
        "TaskProgress",
        TaskID=task_id,
        VehicleID=vehicle_id,
        Time=at_ms,
        Phase=phase,
        Served=served,
        Note=note,
    )
