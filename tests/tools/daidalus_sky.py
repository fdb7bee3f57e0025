"""What the tests of the DAIDALUS services share: aircraft that do as they are told, on one bus."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pipeline_tools import Rig
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.core.well_clear import violation
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame, Position

DETECTION, RESPONSE = "DAIDALUS_WCV_Detection", "DAIDALUS_WCV_Response"
SEES = f'Type="{DETECTION}" VehicleID="2" TurnRate="3"'
ACTS = f'Type="{RESPONSE}" VehicleID="2"'
PLANE = Projection(Frame(0.0, 0.0))
VOLUME = (1222.32, 137.16, 35.0, 0.0)
TURN_DEG_S = 3.0


def where(north_m: float, east_m: float, alt_m: float = 1000.0) -> Any:
    latitude, longitude = PLANE.to_geodetic(north_m, east_m)
    return lmcp.new(
        "Location3D", Latitude=latitude, Longitude=longitude, Altitude=alt_m, AltitudeType="MSL"
    )


def state(
    number: int,
    north_m: float,
    east_m: float,
    course: float,
    speed: float,
    time_ms: int,
    **more: Any,
) -> Any:
    more = {"Heading": course, "Airspeed": speed, **more}
    place = where(north_m, east_m, more.pop("alt_m", 1000.0))
    return lmcp.new(
        "AirVehicleState",
        ID=number, Location=place, Course=course, Groundspeed=speed, Time=time_ms, **more,
    )  # fmt: skip


def mission(number: int, *points: tuple[float, float], speed: float = 50.0) -> Any:
    waypoints = []
    for k, (north, east) in enumerate(points, 1):
        place = where(north, east)
        waypoints.append(
            lmcp.new(
                "Waypoint",
                Number=k, NextWaypoint=min(k + 1, len(points)), Speed=speed,
                Latitude=place.Latitude, Longitude=place.Longitude, Altitude=1000.0,
                AltitudeType="MSL",
            )
        )  # fmt: skip
    return lmcp.new("MissionCommand", VehicleID=number, WaypointList=waypoints, FirstWaypoint=1)


def zone(kind: str, number: int, *corners: tuple[float, float], **more: Any) -> Any:
    boundary = lmcp.new("Polygon", BoundaryPoints=[where(n, e) for n, e in corners])
    return lmcp.new(kind, ZoneID=number, Label=f"zone {number}", Boundary=boundary, **more)


def box(low_n: float, low_e: float, high_n: float, high_e: float) -> list[tuple[float, float]]:
    return [(low_n, low_e), (low_n, high_e), (high_n, high_e), (high_n, low_e)]


class Sky(Rig):
    """A process in virtual time with services given as elements of a configuration."""

    def __init__(self, folder: Path, *services: str) -> None:
        text = "\n".join(f"<Service {s}/>" for s in services)
        self.one, self.said = process(write_cfg(folder, text), virtual=True)
        self.all: list[Any] = []
        self.one.bus.tap(self.all.append)

    def states(self, number: int) -> list[str]:
        """The words for the state of a vehicle's response, as they were told, without repetition."""
        told: list[str] = []
        for body in self.got("ServiceStatus"):
            pairs = {pair.Key: pair.Value for pair in body.Info}
            word = pairs.get("state") if pairs.get("VehicleID") == str(number) else None
            if word is not None and told[-1:] != [word]:
                told.append(word)
        return told


@dataclass
class Craft:
    """An aircraft that flies waypoints or headings as it is commanded; heading in degrees, the air
    moves with the wind (north, east) [m/s]."""

    number: int
    north: float
    east: float
    heading: float
    speed: float = 50.0
    wind: tuple[float, float] = (0.0, 0.0)
    wanted: float | None = None
    mission: Any = None
    waypoint: int = 1
    flown: list[Position] = field(default_factory=list)

    @property
    def velocity(self) -> tuple[float, float]:
        """North and east over ground [m/s]."""
        angle = math.radians(self.heading)
        return (
            self.speed * math.cos(angle) + self.wind[0],
            self.speed * math.sin(angle) + self.wind[1],
        )

    def state(self, time_ms: int) -> Any:
        north, east = self.velocity
        course = math.degrees(math.atan2(east, north))
        source = math.degrees(math.atan2(-self.wind[1], -self.wind[0]))
        return state(
            self.number, self.north, self.east, course, math.hypot(north, east), time_ms,
            Heading=self.heading, Airspeed=self.speed, WindSpeed=math.hypot(*self.wind),
            WindDirection=source, CurrentWaypoint=self.waypoint,
            Mode="Waypoint" if self.wanted is None else "FlightDirector",
        )  # fmt: skip

    def obey(self, bodies: list[Any]) -> None:
        for body in bodies:
            kind = type(body).__name__
            if kind == "VehicleActionCommand" and body.VehicleID == self.number:
                self.wanted = body.VehicleActionList[0].Heading
            if kind == "MissionCommand" and body.VehicleID == self.number:
                self.wanted, self.mission = None, body
                self.waypoint = body.FirstWaypoint

    def fly(self, step_s: float) -> None:
        wanted = self.heading if self.wanted is None else self.wanted
        if self.wanted is None and self.mission is not None:
            goal = next(w for w in self.mission.WaypointList if w.Number == self.waypoint)
            north, east = PLANE.to_local(goal.Latitude, goal.Longitude)
            if math.hypot(north - self.north, east - self.east) < 200.0:
                self.waypoint = goal.NextWaypoint
            wanted = math.degrees(math.atan2(east - self.east, north - self.north))
        turn = (wanted - self.heading + 180.0) % 360.0 - 180.0
        most = TURN_DEG_S * step_s
        self.heading = (self.heading + max(-most, min(most, turn))) % 360.0
        north, east = self.velocity
        self.north += north * step_s
        self.east += east * step_s
        self.flown.append(Position(self.north, self.east, 1000.0))


def lost(one: Craft, other: Craft) -> bool:
    """Well clear is lost now, by the proved kernel."""
    s = Vec2(one.north - other.north, one.east - other.east)
    v = Vec2(one.velocity[0] - other.velocity[0], one.velocity[1] - other.velocity[1])
    return bool(violation(s, v, 0.0, 0.0, *VOLUME))


def fly(sky: Sky, crafts: list[Craft], seconds: int, step_s: float = 1.0) -> list[bool]:
    """Let all fly; whether well clear was lost between the first and any other, at each step."""
    losses = []
    for k in range(int(seconds / step_s)):
        before = len(sky.all)
        time_ms = int(1000 * step_s * k) + 1000
        sky.wait(int(1000 * step_s))
        sky.tell(*(c.state(time_ms) for c in reversed(crafts)))
        for c in crafts:
            c.obey([e.body for e in sky.all[before:]])
            c.fly(step_s)
        losses.append(any(lost(crafts[0], other) for other in crafts[1:]))
    return losses


def head_on(**more: Any) -> list[Any]:
    return [state(1, 6000.0, 0.0, 180.0, 50.0, 1000, **more), state(2, 0.0, 0.0, 0.0, 50.0, 1000)]


def intervals(sky: Sky) -> Any:
    return sky.got("WellClearViolationIntervals")[-1]
