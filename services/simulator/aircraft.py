"""One simulated aircraft: motion and guidance as a value, and its messages."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, degrees, hypot, isfinite, radians, sin, tan
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import guidance as guide
from cratous.services.simulator.guidance import DIRECTED, LOITER, WAYPOINT, Guidance
from cratous.services.simulator.locations import location_of
from cratous.services.simulator.motion import GRAVITY_M_S2, Command, Motion, body_rates, move
from cratous.services.simulator.performance import Airframe
from cratous.spec.errors import BadInput

LEAST_RADIUS_M = 10.0
"""Smallest radius of a circle that it chooses itself [m]."""


class Aircraft(NamedTuple):
    """id, airframe; motion, greatest bank in force [rad], guidance; shown_command, shown_waypoint: in the
    last published state; first: its initial state.
    """

    id: int
    airframe: Airframe
    motion: Motion
    max_bank_rad: float
    guidance: Guidance
    first: Any
    shown_command: int
    shown_waypoint: int


def aircraft_of(body: Any, airframe: Airframe, before: Aircraft | None, where: str) -> Aircraft:
    """An aircraft placed by an AirVehicleState; it keeps its previous guidance."""
    place = body.Location
    numbers = (place.Latitude, place.Longitude, place.Altitude, body.Heading, body.Pitch,
               body.Roll, body.u, body.Airspeed, body.EnergyAvailable)  # fmt: skip
    if not all(map(isfinite, numbers)) or abs(place.Latitude) > 89.9:
        raise BadInput(
            "a state that cannot be flown",
            where=where,
            item=f"AirVehicleState {body.ID}",
            expected="finite numbers, Latitude between -89.9 and 89.9 deg",
            got=str(numbers),
        )
    heading, pitch = radians(body.Heading), radians(body.Pitch)
    speed = body.u if airframe.compatible or body.u else body.Airspeed
    # AMASE begins at rest over ground, and turns north for an instant
    north, east = 0.0, 0.0
    if not airframe.compatible:
        north, east = speed * cos(pitch) * cos(heading), speed * cos(pitch) * sin(heading)
    if before is not None:
        north, east = before.motion.north_m_s, before.motion.east_m_s
    motion = Motion(
        radians(place.Latitude),
        radians(place.Longitude),
        place.Altitude,
        heading,
        pitch,
        radians(body.Roll),
        speed,
        north,
        east,
        0.0,
        body.EnergyAvailable,
        body.ActualEnergyRate,
    )
    command = Command(heading, place.Altitude, body.Airspeed, 0.0)
    held = (
        before.guidance._replace(command=command)
        if before
        else Guidance(command, airframe.compatible, airframe.min_speed_m_s)
    )
    bank = radians(airframe.levels[0].max_bank_deg)
    return Aircraft(
        body.ID, airframe, motion, bank, held, body, body.CurrentCommand, body.CurrentWaypoint
    )


def step(a: Aircraft, wind_m_s: tuple[float, float], ground_m: float, dt_s: float) -> Aircraft:
    """The aircraft after a step."""
    motion, bank = move(a.motion, a.guidance.command, a.airframe, wind_m_s, ground_m, dt_s)
    held = guide.guide(a.guidance, motion, bank, dt_s)
    number, airframe, _, _, _, first, command, waypoint = a
    return Aircraft(number, airframe, motion, bank, held, first, command, waypoint)


def receive(a: Aircraft, body: Any, told: Mapping[int, int] = guide.NOTHING) -> Aircraft:
    """The aircraft after a MissionCommand, with the reported numbers of its waypoints, or a
    VehicleActionCommand.
    """
    if type(body).__name__ == "MissionCommand":
        return a._replace(guidance=guide.mission(a.guidance, body, told))
    return a._replace(guidance=guide.command(a.guidance, body))


def circle_m(a: Aircraft, speed_m_s: float) -> float:
    """A comfortable circle radius at an airspeed [m]: twice that of the tightest turn."""
    speed = a.airframe.within(speed_m_s)
    return max(LEAST_RADIUS_M, 2 * speed * speed / (GRAVITY_M_S2 * tan(a.max_bank_rad)))


class Shown(NamedTuple):
    """Guidance in a published state: mode, command, waypoint and tasks."""

    mode: str
    command: int
    waypoint: int
    tasks: tuple[int, ...]


def shown(a: Aircraft) -> Shown:
    """Guidance in the next state; command and waypoint are kept where the mode has none."""
    g = a.guidance
    mode, waypoint, number = g.mode, a.shown_waypoint, a.shown_command
    tasks: tuple[int, ...] = ()
    if mode == WAYPOINT and g.leg.to is not None:
        number, waypoint, tasks = g.route_id, g.leg.to.number, g.leg.to.tasks
    elif mode == LOITER:
        number = g.loiter_id
        if g.at_waypoint and g.leg.to is not None:
            tasks = g.leg.to.tasks
    if g.directed_id is not None:
        mode, number = DIRECTED, g.directed_id
    return Shown(mode, number, waypoint, tasks)


def ground_motion(a: Aircraft, wind_m_s: tuple[float, float]) -> tuple[float, float]:
    """Ground speed [m/s] and course [rad] as published; AMASE subtracts the wind twice."""
    north, east = a.motion.north_m_s, a.motion.east_m_s
    if a.airframe.compatible:
        north, east = north - wind_m_s[0], east - wind_m_s[1]
    return hypot(north, east), atan2(east, north)


def state(
    a: Aircraft, wind_m_s: tuple[float, float], time_ms: int, payloads: tuple[Any, ...] = ()
) -> tuple[Aircraft, Any]:
    """The aircraft after publishing its AirVehicleState, and that message."""
    m, what = a.motion, shown(a)
    speed, course = ground_motion(a, wind_m_s)
    rates = body_rates(m)
    if not a.airframe.compatible:  # AMASE publishes rad/s although the message has deg/s
        rates = degrees(rates[0]), degrees(rates[1]), degrees(rates[2])
    wind: dict[str, float] = {}
    if not a.airframe.compatible:
        wind = {
            "WindSpeed": hypot(*wind_m_s),
            "WindDirection": degrees(atan2(wind_m_s[1], wind_m_s[0])) % 360,
        }
    body = lmcp.new(
        "AirVehicleState",
        ID=a.id,
        u=m.airspeed_m_s,
        p=rates[0],
        q=rates[1],
        r=rates[2],
        Heading=degrees(m.heading_rad),
        Pitch=degrees(m.pitch_rad),
        Roll=degrees(m.roll_rad),
        Airspeed=m.airspeed_m_s,
        Groundspeed=speed,
        Course=degrees(course),
        VerticalSpeed=m.climb_m_s,
        Location=location_of(m),
        EnergyAvailable=m.energy_percent,
        ActualEnergyRate=m.energy_percent_s,
        PayloadStateList=list(payloads),
        CurrentWaypoint=what.waypoint,
        CurrentCommand=what.command,
        Mode=what.mode,
        AssociatedTasks=list(what.tasks),
        Time=time_ms,
        **wind,
    )
    return a._replace(shown_command=what.command, shown_waypoint=what.waypoint), body
