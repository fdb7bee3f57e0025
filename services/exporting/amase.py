"""A mission as an AMASE scenario: all entities, each from the time it appears."""

from __future__ import annotations

import math
from typing import Any
from xml.sax.saxutils import escape

from cratous.bridge import lmcp
from cratous.bridge.lmcp.xml_writing import dumps
from cratous.services.exporting.messages import Told, state_of
from cratous.services.loading.amase import TRAFFIC
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Mission, Traffic

TURN_RAD = math.radians(45.0)
"""Maximum bank angle of traffic [rad], for which a mission has no value; it flies straight."""


def scenario_text(
    mission: Mission, told: Told, duration_s: float, sets_out_s: float = 0.0, *, tasks: bool = False
) -> str:
    """The XML. duration_s: duration [s]; sets_out_s: scenario time at which the aircraft appear and
    the mission starts [s]; tasks: include zones and tasks, which the simulator forwards to its
    clients.
    """
    plane = Projection(mission.frame)
    events = [_event(body, 0.0) for body in told.configurations]
    if tasks:
        events += [_event(body, 0.0) for body in (*told.zones, told.region, *told.tasks)]
    events += [_event(body, sets_out_s) for body in told.states]
    for one in mission.traffic:
        events += [
            _event(body, sets_out_s + at_ms / 1000) for body, at_ms in traffic_events(one, plane)
        ]
    return (
        "<AMASE>\n<ScenarioData>\n"
        f"<ScenarioName>{escape(mission.name)}</ScenarioName>\n"
        f"<ScenarioDuration>{duration_s:.3f}</ScenarioDuration>\n</ScenarioData>\n"
        "<ScenarioEventList>\n" + "\n".join(events) + "\n</ScenarioEventList>\n</AMASE>\n"
    )


def _event(body: Any, time_s: float) -> str:
    name = type(body).__name__
    return dumps(body).replace(f"<{name} ", f'<{name} Time="{time_s:.3f}" ', 1).rstrip("\n")


def traffic_events(one: Traffic, plane: Projection) -> list[tuple[Any, int]]:
    """The events of an uncommanded aircraft, each with its time [ms]."""
    north, east = one.velocity.north_m_s, one.velocity.east_m_s
    speed = math.hypot(north, east)
    profile = lmcp.new(
        "FlightProfile", Name="Cruise", Airspeed=speed, MaxBankAngle=math.degrees(TURN_RAD)
    )
    configuration = lmcp.new(
        "AirVehicleConfiguration",
        ID=one.id,
        Info=[lmcp.new("KeyValuePair", Key=TRAFFIC[0], Value=TRAFFIC[1])],
        Label=f"traffic {one.id}",
        NominalSpeed=speed,
        NominalAltitude=one.position.alt_m,
        NominalAltitudeType="MSL",
        MinimumSpeed=speed,
        MaximumSpeed=speed,
        NominalFlightProfile=profile,
    )
    state = state_of(one.id, one.position, math.atan2(east, north), speed, plane)
    found = [(configuration, one.appears_ms), (state, one.appears_ms)]
    if one.vanishes_ms is not None:
        gone = lmcp.new("RemoveEntities", EntityList=[one.id])
        found.append((gone, one.vanishes_ms))
    return found
