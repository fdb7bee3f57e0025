"""ICAROUS's steering as commands for the autopilot: SETVEL, SETPOS, GOTOWP; and circles."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.bridge.text_protocol import GoToWaypoint, Message, SetPosition, SetVelocity
from cratous.core.authority.gate import UXAS, Gate
from cratous.core.avoidance.manoeuvre import velocity_of
from cratous.services.flight.commands import gated
from cratous.services.flight.dynamics import GRAVITY_M_S2, AirState
from cratous.services.flight.messages import Say
from cratous.services.flight.notices import authority_change, gate_state
from cratous.services.icarous_communication.plans import START, Plan
from cratous.services.mission.frames import Projection, compass
from cratous.spec.errors import BadInput

AHEAD_S = 10.0
"""A SETVEL commands the altitude that its climb rate reaches after this [s]; the next SETVEL follows much
sooner.
"""
COMMANDS = ("MissionCommand", "VehicleActionCommand")
HOLD_BANK_RAD = math.radians(20.0)
"""Bank angle of the circles about a place that ICAROUS sets [rad]; UxAS's own holds are `circle_about`."""


def action_of(line: Message, air: AirState, plan: Plan | None, projection: Projection) -> Any:
    """The VehicleAction for a steering line, from an aircraft's present motion; None for a line that does not
    steer. BadInput for a waypoint that the plan does not have.
    """
    match line:
        case SetVelocity(north, east, down):
            altitude = air.position.alt_m - down * AHEAD_S
            if not (north or east):
                return _stay(air, projection, altitude)
            return lmcp.new(
                "FlightDirectorAction",
                Speed=math.hypot(north, east),
                SpeedType="Groundspeed",
                Heading=compass(math.atan2(east, north)),
                Altitude=altitude,
                AltitudeType="MSL",
                ClimbRate=-down,
            )
        case SetPosition(lat, long, alt):
            return _loiter(lat, long, alt, air)
        case GoToWaypoint(index):
            marks = () if plan is None else plan.marks
            numbers = [
                waypoint.Number
                for waypoint, mark in zip(
                    () if plan is None else plan.waypoints, marks, strict=True
                )
                if mark == index and waypoint.Number != START
            ]
            if not numbers:
                raise BadInput(
                    "GOTOWP of a waypoint that is not there",
                    item="id",
                    expected=f"0 to {max(marks)}" if marks else "a plan first",
                    got=str(index),
                )
            return lmcp.new("GoToWaypointAction", WaypointNumber=numbers[-1])
    return None


def _stay(air: AirState, projection: Projection, altitude_m: float) -> Any:
    """Loiter at the aircraft's position, at an altitude [m MSL]."""
    place = air.position
    lat, long = projection.to_geodetic(place.north_m, place.east_m)
    return _loiter(lat, long, altitude_m, air)


def circle_about(lat_deg: float, long_deg: float, air: AirState, radius_m: float, turn: str) -> Any:
    """A circle at the aircraft's altitude and speed. turn: Clockwise or CounterClockwise."""
    loiter = _loiter(lat_deg, long_deg, air.position.alt_m, air)
    return loiter.copy(Radius=radius_m, Direction=turn)


def command_of(vehicle_id: int, command_id: int, action: Any) -> Any:
    """A VehicleActionCommand with one action."""
    return lmcp.new(
        "VehicleActionCommand",
        CommandID=command_id,
        VehicleID=vehicle_id,
        VehicleActionList=[action],
    )


def circle_m(speed_m_s: float) -> float:
    """Radius of such a circle [m]."""
    return speed_m_s**2 / (GRAVITY_M_S2 * math.tan(HOLD_BANK_RAD))


def flies(line: Message, air: AirState | None, projection: Projection) -> Message:
    """A steering line as a velocity: SETPOS becomes straight flight to its place at the present speed."""
    if not isinstance(line, SetPosition) or air is None:
        return line
    north, east = projection.to_local(line.lat_deg, line.long_deg)
    course = math.atan2(east - air.position.east_m, north - air.position.north_m)
    v = velocity_of(course, air.speed_m_s, 0.0)
    return SetVelocity(v.north_m_s, v.east_m_s, v.down_m_s)


def _loiter(lat_deg: float, long_deg: float, alt_m: float, air: AirState) -> Any:
    place = lmcp.new("Location3D", Latitude=lat_deg, Longitude=long_deg, Altitude=alt_m)
    return lmcp.new(
        "LoiterAction",
        LoiterType="Circular",
        Radius=circle_m(air.speed_m_s),
        Direction="Clockwise",
        Duration=-1,
        Airspeed=air.speed_m_s,
        Location=place,
    )


def at_gate(name: str, vehicle_id: int, gate: Gate, sender: int, command: Any) -> Say:
    """A `GatedCommand` for the bus: a command from a sender has reached a vehicle's gate."""
    return Say(gated(vehicle_id, gate.epoch, sender, command), name)


def in_flight(name: str, vehicle_id: int, gate: Gate, plan: Plan | None) -> list[Say]:
    """The command that a vehicle already flies, for its newly set up gate; none without a plan."""
    return [] if plan is None else [at_gate(name, vehicle_id, gate, UXAS, plan.command)]


def taken_back(
    name: str, vehicle_id: int, now_ms: int, gate: Gate, onward: Iterable[object]
) -> list[Say]:
    """The gate's state before UxAS takes an offer, and the first command that takes it. gate: before; onward:
    what the vehicle is sent.
    """
    found = [Say(gate_state(vehicle_id, now_ms, gate), name)] if gate.offered else []
    said = (one.body for one in onward if isinstance(one, Say))
    command = next((body for body in said if type(body).__name__ in COMMANDS), None)
    if command is not None:
        found.append(at_gate(name, vehicle_id, gate, UXAS, command))
    return found


def told(name: str, vehicle_id: int, now_ms: int, gate: Gate) -> list[Say]:
    """A gate's state and who commands from now on, for the bus. name: the sender."""
    change = authority_change(vehicle_id, now_ms, gate, "SETMOD", 0)
    return [Say(gate_state(vehicle_id, now_ms, gate), name), Say(change, name)]
