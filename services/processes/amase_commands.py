"""Deviations of AMASE from the standard, and commands to repeat after its restart.

- GoToWaypointAction in a VehicleActionCommand: it flies straight on forever. The mission command is
  sent again, from that waypoint on.
- An aircraft that leaves its waypoints keeps its vertical speed in a loiter, forever. A flight director
  command that levels it is sent first, separately: of two actions in one command AMASE executes only the
  first.
- A camera without a resolution gets footprints that are not numbers. It is given a resolution of its
  aspect ratio.
"""

from __future__ import annotations

from math import isfinite
from typing import Any

from cratous.bridge import lmcp
from cratous.spec.mission import Vehicle

STEERS = ("FlightDirectorAction", "LoiterAction", "GoToWaypointAction")

PIXELS = 1600
"""Image width assumed where none is configured [pixels]."""


def with_pixels(configuration: Any, vehicle: Vehicle) -> Any:
    """The configuration of a vehicle with the resolution of each camera, by its aspect ratio."""
    aspects, parts = iter(vehicle.cameras), []
    for part in configuration.PayloadConfigurationList:
        if type(part).__name__ == "CameraConfiguration":
            camera = next(aspects)
            if not part.VideoStreamHorizontalResolution or not part.VideoStreamVerticalResolution:
                part = part.copy(
                    VideoStreamHorizontalResolution=PIXELS,
                    VideoStreamVerticalResolution=round(PIXELS / camera.aspect),
                )
        parts.append(part)
    return configuration.copy(PayloadConfigurationList=parts)


def without_numbers(state: Any) -> str:
    """The first position or velocity field of a state that is not finite; "" if all are finite."""
    at = state.Location
    told = {
        **{name: getattr(at, name) for name in ("Latitude", "Longitude", "Altitude")},
        **{name: getattr(state, name) for name in ("Course", "Groundspeed", "VerticalSpeed")},
    }
    return next((name for name, value in told.items() if not isfinite(value)), "")


def seen(payload: Any) -> Any:
    """The state of a payload, with its footprint removed if that is not finite."""
    corners = getattr(payload, "Footprint", ())
    if all(isfinite(c.Latitude) and isfinite(c.Longitude) for c in corners):
        return payload
    return payload.copy(Footprint=[])


class Standing:
    """The commands in force of a vehicle: its mission, what steers it away from that, and those of its
    payloads.
    """

    def __init__(self) -> None:
        self.mission: Any = None
        self.steers: list[Any] = []
        self.others: dict[str, Any] = {}

    def again(self, state: Any) -> list[Any]:
        """The commands in force, for a restarted AMASE. state: the last one received."""
        mission = [] if self.mission is None else [from_waypoint(self.mission, state)]
        return [*mission, *self.steers, *self.others.values()]


def for_amase(body: Any, standing: Standing, state: Any) -> list[Any]:
    """What is sent for a MissionCommand or VehicleActionCommand, which is recorded in `standing`.

    state: the vehicle's last one, None if none was received.
    """
    if type(body).__name__ == "MissionCommand":
        standing.mission, standing.steers = body, []
        return [body]
    actions = {type(action).__name__: action for action in body.VehicleActionList if action}
    mission, goes, loiter = (
        standing.mission, actions.get("GoToWaypointAction"), actions.get("LoiterAction"),
    )  # fmt: skip
    if goes is not None and mission is not None and goes.WaypointNumber in _numbers(mission):
        standing.mission, standing.steers = mission.copy(FirstWaypoint=goes.WaypointNumber), []
        rest = [action for action in body.VehicleActionList if action is not goes]
        more = for_amase(body.copy(VehicleActionList=rest), standing, state) if rest else []
        return [standing.mission, *more]
    if not any(kind in STEERS for kind in actions):
        key = " ".join(f"{kind} {getattr(a, 'PayloadID', 0)}" for kind, a in actions.items())
        standing.others[key] = body
        return [body]
    levelled = [] if loiter is None or state is None else [level(body, loiter, state)]
    standing.steers = [*levelled, body]
    return list(standing.steers)


def level(body: Any, loiter: Any, state: Any) -> Any:
    """The command to fly level at the altitude of a loiter."""
    action = lmcp.new(
        "FlightDirectorAction",
        Speed=loiter.Airspeed,
        Heading=state.Heading,
        Altitude=loiter.Location.Altitude,
        AltitudeType=loiter.Location.AltitudeType,
        ClimbRate=0.0,
    )
    return body.copy(VehicleActionList=[action])


def from_waypoint(mission: Any, state: Any) -> Any:
    """A mission command that starts at the waypoint to which the vehicle was last flying."""
    if state is None or state.CurrentWaypoint not in _numbers(mission):
        return mission
    return mission.copy(FirstWaypoint=state.CurrentWaypoint)


def _numbers(mission: Any) -> list[int]:
    return [point.Number for point in mission.WaypointList]
