"""Validation of commands: null parts, invalid places and numbers."""

from __future__ import annotations

from math import isfinite
from typing import Any

from cratous.spec.errors import BadInput

LISTS = (
    "WaypointList", "VehicleActionList", "MissionCommandList", "VehicleCommandList",
    "AlternateFlightProfiles",
)  # fmt: skip
NUMBERS = {
    "LoiterAction": ("Radius", "Length", "Axis", "Airspeed"),
    "FlightDirectorAction": ("Heading", "Altitude", "Speed", "ClimbRate"),
    "SpeedOverrideAction": ("Speed",),
    "GimbalAngleAction": ("Azimuth", "Elevation"),
    "GimbalScanAction": (
        "StartAzimuth", "EndAzimuth", "StartElevation", "EndElevation",
        "AzimuthSlewRate", "ElevationSlewRate",
    ),
    "CameraAction": ("HorizontalFieldOfView",),
}  # fmt: skip


def present(body: Any, where: str) -> None:
    """BadInput for null in a list of the object or its parts; elsewhere the codec rejects it."""
    kind = type(body).__name__
    for name in LISTS:
        for k, part in enumerate(getattr(body, name, ())):
            if part is None:
                raise BadInput("null in a list", where=where, item=f"{kind}.{name}[{k}]")
            present(part, where)


def check_command(body: Any, where: str, *, flies: bool = True) -> None:
    """BadInput for a MissionCommand or VehicleActionCommand that cannot be executed; loiter circles are
    checked only for vehicles that fly.
    """
    name = f"{type(body).__name__} {body.CommandID}"
    waypoints = list(getattr(body, "WaypointList", ()))
    actions = [*getattr(body, "VehicleActionList", ())]
    for waypoint in waypoints:
        check_place(waypoint, where, name)
        _finite((waypoint.Speed,), where, f"{name}: Speed")
        actions += waypoint.VehicleActionList
    for action in actions:
        kind = type(action).__name__
        numbers = tuple(getattr(action, field) for field in NUMBERS.get(kind, ()))
        _finite(numbers, where, f"{name}: {kind}")
        if kind == "LoiterAction":
            check_place(action.Location, where, name)
            if flies and (not action.Radius > 0 or not action.Length >= 0):
                raise BadInput(
                    "a loiter that cannot be flown",
                    where=where,
                    item=name,
                    expected="Radius above 0, Length at least 0 [m]",
                    got=f"Radius {action.Radius:g}, Length {action.Length:g}",
                )
        elif kind == "GimbalStareAction":
            check_place(action.Starepoint, where, name)


def _finite(numbers: tuple[float, ...], where: str, item: str) -> None:
    if not all(map(isfinite, numbers)):
        raise BadInput("not a number", where=where, item=item, got=str(numbers))


def check_place(place: Any, where: str, item: str) -> None:
    """BadInput for an invalid place."""
    numbers = (place.Latitude, place.Longitude, place.Altitude)
    if not all(map(isfinite, numbers)) or abs(place.Latitude) > 90:
        raise BadInput(
            "a place that cannot be flown to",
            where=where,
            item=item,
            expected="finite numbers, Latitude between -90 and 90 deg",
            got=str(numbers),
        )
