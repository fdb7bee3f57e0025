"""What AMASE is told otherwise than the standard says, and again when it is begun anew."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.loading import load
from cratous.services.processes.amase_commands import Standing, for_amase, seen, with_pixels
from cratous.services.processes.coverage import told_of


def steered(vehicle: int, *actions: Any) -> Any:
    return lmcp.new(
        "VehicleActionCommand", CommandID=7, VehicleID=vehicle, VehicleActionList=[*actions]
    )


def waypoints(*numbers: int) -> Any:
    points = [
        lmcp.new("Waypoint", Number=n, NextWaypoint=n + 1, Latitude=37.1 + n / 100, Longitude=-76.4,
                 Altitude=300.0, Speed=22.0)
        for n in numbers
    ]  # fmt: skip
    return lmcp.new(
        "MissionCommand", CommandID=5, VehicleID=1, WaypointList=points, FirstWaypoint=numbers[0]
    )


def test_going_to_a_waypoint_is_the_mission_from_there_on() -> None:
    """By GoToWaypointAction alone AMASE flies straight on for ever."""
    standing = Standing()
    mission = waypoints(3, 4, 5)
    assert for_amase(mission, standing, None) == [mission]
    away = steered(1, lmcp.new("FlightDirectorAction", Heading=90))
    assert for_amase(away, standing, None) == [away]
    assert standing.again(None) == [mission, away]
    goes = steered(1, lmcp.new("GoToWaypointAction", WaypointNumber=4))
    (sent,) = for_amase(goes, standing, None)
    assert (type(sent).__name__, sent.FirstWaypoint, sent.CommandID) == ("MissionCommand", 4, 5)
    assert standing.again(None) == [sent]
    unknown = steered(1, lmcp.new("GoToWaypointAction", WaypointNumber=99))
    assert for_amase(unknown, standing, None) == [unknown]


def test_who_is_told_to_loiter_is_levelled_before() -> None:
    """In a loiter AMASE keeps the vertical speed that it had."""
    place = lmcp.new("Location3D", Latitude=37.1, Longitude=-76.4, Altitude=320.0)
    loiter = steered(1, lmcp.new("LoiterAction", Location=place, Airspeed=20.0, Radius=200.0))
    state = lmcp.new("AirVehicleState", ID=1, Heading=33.0, VerticalSpeed=4.0)
    first, second = for_amase(loiter, Standing(), state)
    (action,) = first.VehicleActionList
    assert (action.ClimbRate, action.Altitude, action.Heading, action.Speed) == (0, 320, 33, 20)
    assert second == loiter


def test_cameras_hold_what_they_were_told_while_the_vehicle_is_steered() -> None:
    standing = Standing()
    stare = steered(1, lmcp.new("GimbalStareAction", PayloadID=1))
    angle = steered(1, lmcp.new("GimbalStareAction", PayloadID=1, Duration=5))
    for body in (waypoints(1, 2), stare, angle, steered(1, lmcp.new("FlightDirectorAction"))):
        for_amase(body, standing, None)
    state = lmcp.new("AirVehicleState", ID=1, CurrentWaypoint=2)
    mission, steers, camera = standing.again(state)
    assert mission.FirstWaypoint == 2, "it goes on with the waypoint that it made for"
    assert type(steers.VehicleActionList[0]).__name__ == "FlightDirectorAction"
    assert camera == angle
    for_amase(waypoints(6, 7), standing, None)
    assert [type(body).__name__ for body in standing.again(None)] == [
        "MissionCommand",
        "VehicleActionCommand",
    ]


def test_a_camera_has_an_image_and_a_footprint_that_is_none_is_left_out(root: Path) -> None:
    crossing = load(root / "examples/crossing/mission.yaml", 0)
    vehicle, made = crossing.vehicles[0], told_of(crossing).configurations[0]
    (camera,) = [
        part
        for part in with_pixels(made, vehicle).PayloadConfigurationList
        if type(part).__name__ == "CameraConfiguration"
    ]
    wide, high = camera.VideoStreamHorizontalResolution, camera.VideoStreamVerticalResolution
    assert wide / high == pytest.approx(vehicle.cameras[0].aspect, rel=1e-3)
    corner = lmcp.new("Location3D", Latitude=37.0, Longitude=-76.0)
    whole = lmcp.new("CameraState", Footprint=[corner])
    assert seen(whole) is whole
    assert seen(whole.copy(Footprint=[corner, corner.copy(Latitude=math.nan)])).Footprint == []
