"""Commands that a vehicle gives itself: staying at a place, or reacting to the loss of what it tracks."""

from __future__ import annotations

from typing import Any

from cratous.bridge import lmcp
from cratous.services.simulator.aircraft import Aircraft, circle_m
from cratous.services.simulator.driver import Driver
from cratous.services.simulator.guidance import LOITER
from cratous.services.simulator.tracking import Track


def stay(key: int, command: int, one: Aircraft | Driver, at: Any) -> Any:
    """The command to stay at a place indefinitely; an aircraft circles at its present altitude and speed."""
    more: dict[str, Any] = {"Location": at}
    if isinstance(one, Aircraft):
        speed = max(one.motion.airspeed_m_s, one.guidance.command.speed_m_s)
        speed = speed or one.airframe.levels[0].airspeed_m_s
        more = {"Radius": circle_m(one, speed), "Airspeed": speed,
                "Location": at.copy(Altitude=one.motion.alt_m, AltitudeType="MSL")}  # fmt: skip
    return _command(key, command, lmcp.new("LoiterAction", LoiterType="Hover", **more))


def circles(one: Aircraft | Driver) -> bool:
    """Whether an aircraft circles and has no route to continue on."""
    return isinstance(one, Aircraft) and one.guidance.route is None and one.guidance.mode == LOITER


def fall_back(key: int, track: Track, time_s: float, one: Aircraft | Driver) -> tuple[str, Any]:
    """Report and command of a vehicle that has lost what it tracks; command None if it was commanded
    otherwise since.
    """
    said = f"vehicle {key} has lost entity {track.entity} at {time_s:.1f} s"
    if track.return_to is None:
        return f"{said}: it does what it was told since", None
    if isinstance(one, Aircraft):
        route, command = one.guidance.route or {}, one.shown_command
    else:
        route, command = one.course.route, one.told[0]
    if track.return_to not in route:
        return f"{said}: it stays about the place", stay(key, command, one, track.at)
    go = lmcp.new("GoToWaypointAction", WaypointNumber=track.return_to)
    return f"{said}: it goes to waypoint {track.return_to}", _command(key, command, go)


def _command(key: int, command: int, action: Any) -> Any:
    return lmcp.new(
        "VehicleActionCommand", CommandID=command, VehicleID=key, VehicleActionList=[action]
    )
