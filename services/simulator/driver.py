"""Ground and surface vehicles of a world: commands to them, and their states."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import degrees, isfinite, radians
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import course, payload
from cratous.services.simulator.course import Course
from cratous.services.simulator.driving import Chassis, chassis_of, move
from cratous.services.simulator.earth import ahead
from cratous.services.simulator.guidance import DIRECTED, LOITER, NOTHING
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.perception import Body
from cratous.services.simulator.tracking import Tracks
from cratous.spec.errors import BadInput

if TYPE_CHECKING:
    from cratous.services.simulator.terrain import Terrain

STATES = {
    "GroundVehicleConfiguration": "GroundVehicleState",
    "SurfaceVehicleConfiguration": "SurfaceVehicleState",
}
"""Kind of a vehicle's states, by the kind of its configuration."""
STANDS = ("Hover", "VehicleDefault")
"""Loiter types that mean a stop; other types are executed as a stop too, with a warning."""


class Driver(NamedTuple):
    """kind: of its states; first: its initial state; told: command and waypoint in the last published state."""

    kind: str
    chassis: Chassis
    motion: Motion
    course: Course
    first: Any
    told: tuple[int, int] = (0, 0)


class Drivers:
    """The ground and surface vehicles of a world, by id. said: warnings about commands that were not executed
    as given.

    terrain: ground vehicles stand on it; without terrain at the altitude of their states, like surface
    vehicles.
    """

    def __init__(self, terrain: Terrain | None = None, tracks: Tracks | None = None) -> None:
        self._terrain = terrain
        self._tracks = tracks or Tracks()
        self.there: dict[int, Driver] = {}
        self.said: list[str] = []
        self._warned: set[str] = set()
        self._chassis: dict[int, tuple[str, Chassis]] = {}
        self._mounted: dict[int, tuple[payload.Gimbal, ...]] = {}

    def __contains__(self, key: int) -> bool:
        return key in self._chassis

    def __len__(self) -> int:
        return len(self._chassis)

    def configure(self, body: Any, where: str) -> None:
        """Add a configuration; BadInput for a vehicle that cannot move."""
        self._chassis[body.ID] = STATES[type(body).__name__], chassis_of(body, where)
        self._mounted[body.ID] = payload.gimbals_of(body, where)

    def place(self, body: Any, where: str) -> None:
        """Place a vehicle by a state, keeping its previous guidance; BadInput for an invalid one."""
        kind = type(body).__name__
        name = f"{kind} {body.ID}"
        configured, chassis = self._chassis.get(body.ID, ("", None))
        if configured != kind or chassis is None:
            raise BadInput(
                "a state of a vehicle without configuration", where=where, item=name,
                expected=f"its {kind.replace('State', 'Configuration')} before it",
            )  # fmt: skip
        at = body.Location
        speed = body.Speed if hasattr(body, "Speed") else body.u or body.Groundspeed
        numbers = (
            at.Latitude,
            at.Longitude,
            at.Altitude,
            body.Heading,
            speed,
            body.EnergyAvailable,
        )
        if not all(map(isfinite, numbers)) or abs(at.Latitude) > 89.9:
            raise BadInput(
                "a state that cannot be driven", where=where, item=name,
                expected="finite numbers, Latitude between -89.9 and 89.9 deg", got=str(numbers),
            )  # fmt: skip
        motion = Motion(
            radians(at.Latitude), radians(at.Longitude), at.Altitude, radians(body.Heading), 0.0, 0.0,
            max(0.0, min(chassis.max_speed_m_s, speed)), 0.0, 0.0, 0.0, body.EnergyAvailable, 0.0,
        )  # fmt: skip
        before = self.there.get(body.ID)
        held = before.course if before else Course()
        told = body.CurrentCommand, body.CurrentWaypoint
        if self._terrain is not None and not chassis.sails:
            motion = _on(self._terrain, motion)
            body = body.copy(Location=at.copy(AltitudeType="MSL"))
        self.there[body.ID] = Driver(kind, chassis, motion, held, body, told)
        self._mounted[body.ID] = payload.placed(self._mounted[body.ID], body)

    def remove(self, key: int) -> None:
        """Remove a vehicle."""
        for held in (self.there, self._chassis, self._mounted):
            held.pop(key, None)

    def command(self, body: Any, told: Mapping[int, int] = NOTHING) -> None:
        """Execute a MissionCommand, with the reported numbers of its waypoints, or a VehicleActionCommand for
        a present vehicle.
        """
        key = body.VehicleID
        one = self.there[key]
        self._warn(body)
        if type(body).__name__ == "MissionCommand":
            held = course.mission(one.course, body, one.motion, one.chassis, told)
        else:
            held = course.command(one.course, body, one.motion, one.chassis)
        self.there[key] = one._replace(course=held)
        self._fire(key)

    def halt(self, key: int) -> Any:
        """Where a vehicle that brakes at once comes to rest."""
        one = self.there[key]
        m = one.motion
        braking_m = m.airspeed_m_s**2 / (2 * one.chassis.along_m_s2)
        lat, lon = ahead(m.lat_rad, m.lon_rad, braking_m, m.heading_rad)
        return one.first.Location.copy(
            Latitude=degrees(lat), Longitude=degrees(lon), Altitude=m.alt_m
        )

    def _warn(self, body: Any) -> None:
        actions = [*body.VehicleActionList]
        for w in getattr(body, "WaypointList", ()):
            actions += w.VehicleActionList
        kinds = {a.LoiterType.name for a in actions if type(a).__name__ == "LoiterAction"}
        for kind in sorted(kinds.difference(STANDS)):
            self._say(
                body.VehicleID,
                f"does not fly: told a loiter of type {kind} it stands at its middle",
            )
        if any(a.Altitude or a.ClimbRate for a in actions if hasattr(a, "ClimbRate")):
            text = "does not fly: of a FlightDirectorAction it takes heading and speed alone"
            self._say(body.VehicleID, text)

    def _say(self, key: int, what: str) -> None:
        text = f"vehicle {key} {what}"
        if text not in self._warned:
            self._warned.add(text)
            self.said.append(text)

    def step(self, dt_s: float) -> None:
        """Advance all vehicles by one step."""
        for key, one in self.there.items():
            held, heading, speed = course.steer(one.course, one.motion, one.chassis, dt_s)
            motion = move(one.motion, heading, speed, one.chassis, dt_s)
            if self._terrain is not None and not one.chassis.sails:
                motion = _on(self._terrain, motion)
            self.there[key] = one._replace(motion=motion, course=held)
            if held.fired:
                self._fire(key)
            if self._mounted[key]:
                steps = (payload.step(p, motion, dt_s) for p in self._mounted[key])
                self._mounted[key] = tuple(steps)

    def _fire(self, key: int) -> None:
        """Execute the collected payload actions."""
        one, mounted = self.there[key], self._mounted[key]
        for body in one.course.fired:
            if self._tracks.act(key, mounted, body):
                continue
            if payload.is_for(mounted, body):
                mounted = tuple(payload.act(p, body) for p in mounted)
            else:
                self._say(key, f"has nothing mounted for a {type(body).__name__}: it is left out")
        self._mounted[key] = mounted
        self.there[key] = one._replace(course=one.course._replace(fired=()))

    def bodies(self) -> Iterator[Body]:
        """All vehicles with their payloads, for perception."""
        for key, one in self.there.items():
            yield Body(key, one.motion, self._mounted[key])

    def stare(self, key: int, body: Any) -> None:
        """Have a gimbal stare at what it tracks."""
        self._mounted[key] = tuple(payload.act(p, body) for p in self._mounted[key])

    def states(self, time_ms: int, ground_m: float) -> Iterator[Any]:
        """The present states of all vehicles."""
        for key, one in self.there.items():
            seen = payload.states(self._mounted[key], one.motion, ground_m, self._terrain)
            self.there[key], body = state(one, time_ms, seen)
            yield body


def _on(terrain: Terrain, m: Motion) -> Motion:
    """The motion at the altitude of the ground."""
    return m._replace(alt_m=terrain.elevation(m.lat_rad, m.lon_rad))


def state(d: Driver, time_ms: int, payloads: tuple[Any, ...]) -> tuple[Driver, Any]:
    """The GroundVehicleState or SurfaceVehicleState to publish, and the vehicle after publishing it."""
    m, c = d.motion, d.course
    number, waypoint = d.told
    tasks: tuple[int, ...] = ()
    if c.mode == DIRECTED:
        number = c.directed_id or number
    elif c.mode == LOITER:
        number = c.stand_id
        tasks = c.to.tasks if c.of_waypoint and c.to is not None else ()
    elif c.to is not None:
        number, waypoint, tasks = c.route_id, c.to.number, c.to.tasks
    more: dict[str, float] = {}
    if d.chassis.sails:
        more = {"BankAngle": degrees(m.roll_rad), "Speed": m.airspeed_m_s}
    body = lmcp.new(
        d.kind,
        ID=d.first.ID,
        u=m.airspeed_m_s,
        r=degrees(m.turning_rad_s),
        p=degrees(m.rolling_rad_s),
        Heading=degrees(m.heading_rad),
        Roll=degrees(m.roll_rad),
        Groundspeed=m.airspeed_m_s,
        Course=degrees(m.heading_rad),
        Location=d.first.Location.copy(
            Latitude=degrees(m.lat_rad), Longitude=degrees(m.lon_rad), Altitude=m.alt_m
        ),
        EnergyAvailable=m.energy_percent,
        ActualEnergyRate=m.energy_percent_s,
        PayloadStateList=list(payloads),
        CurrentWaypoint=waypoint,
        CurrentCommand=number,
        Mode=c.mode,
        AssociatedTasks=list(tasks),
        Time=time_ms,
        **more,
    )
    return d._replace(told=(number, waypoint)), body
