"""What the processes are given, as files: the scenario of the simulator, the configuration and messages of UxAS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

from cratous.bridge import lmcp
from cratous.bridge.lmcp.xml_writing import dumps
from cratous.core.files.whole_file import write_atomically
from cratous.services.mission.frames import Projection
from cratous.services.processes.messages import Told, state_of
from cratous.spec.mission import Mission, Traffic

SCENARIO, CONFIGURATION, MESSAGES = "scenario.xml", "cfg.xml", "messages.xml"
ENTITY = 100
SETS_OUT_S = 0.45
"""When all aircraft are there [s]: just before the simulator tells states for the first time."""
TURN = {"TurnType": "FlyOver"}
"""Waypoints are flown over: a turn that is cut short ends a task before its end is reached."""
LINGERS_S = 600.0
"""The scenario goes on for so long after the mission's limit, which the command watches itself."""
STARTS_S = 900
"""How long UxAS and the ICAROUS instances wait for each other: all check the proofs first."""
TO_RECORDER = (
    "afrl.cmasi.AutomationResponse",
    "afrl.cmasi.MissionCommand",
    "afrl.cmasi.VehicleActionCommand",
    "afrl.cmasi.ServiceStatus",
    "uxas.messages.task.",
    "cratous.",
)
TO_SIMULATOR = ("afrl.cmasi.MissionCommand", "afrl.cmasi.VehicleActionCommand")
TURN_RAD = math.radians(45.0)
"""The bank of traffic, of which a mission says nothing; it flies straight on."""


class Ports(NamedTuple):
    """Ports of loopback: of the simulator, of UxAS for whoever records, and for the ICAROUS instances."""

    simulator: int
    recorder: int
    icarous: int


def write_scenario(mission: Mission, told: Told, folder: Path) -> Path:
    """The scenario of the simulator: vehicles and traffic, each from when it is there."""
    plane = Projection(mission.frame)
    events = [_event(body, 0.0) for body in told.configurations]
    events += [_event(body, SETS_OUT_S) for body in told.states]
    for one in mission.traffic:
        events += [_event(body, SETS_OUT_S + at_ms / 1000) for body, at_ms in _traffic(one, plane)]
    duration_s = mission.simulation.limit_ms / 1000 + LINGERS_S
    text = (
        "<AMASE>\n<ScenarioData>\n"
        f"<ScenarioName>{_escaped(mission.name)}</ScenarioName>\n"
        f"<ScenarioDuration>{duration_s:g}</ScenarioDuration>\n</ScenarioData>\n"
        "<ScenarioEventList>\n" + "\n".join(events) + "\n</ScenarioEventList>\n</AMASE>\n"
    )
    return _written(folder / SCENARIO, text)


def _event(body: Any, time_s: float) -> str:
    name = type(body).__name__
    return dumps(body).replace(f"<{name} ", f'<{name} Time="{time_s:.3f}" ', 1).rstrip("\n")


def _traffic(one: Traffic, plane: Projection) -> list[tuple[Any, int]]:
    """What there is of an aircraft that nobody commands, with the time of each [ms]."""
    north, east = one.velocity.north_m_s, one.velocity.east_m_s
    speed = math.hypot(north, east)
    profile = lmcp.new(
        "FlightProfile", Name="Cruise", Airspeed=speed, MaxBankAngle=math.degrees(TURN_RAD)
    )
    configuration = lmcp.new(
        "AirVehicleConfiguration",
        ID=one.id,
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


def write_messages(told: Told, folder: Path) -> Path:
    """All messages that UxAS is sent, in one file, in order."""
    bodies = "".join(dumps(body) for body in told.all())
    return _written(folder / MESSAGES, f"<Messages>\n{bodies}</Messages>\n")


def write_configuration(
    mission: Mission, instances: Sequence[int], ports: Ports, folder: Path
) -> Path:
    """The configuration of UxAS: bridges, the services of planning, a waypoint manager a vehicle, ICAROUS."""
    search = {"CostFunction": mission.cost, "Semantics": mission.order}
    if mission.node_limit is not None:
        search["NumberNodesMaximum"] = str(mission.node_limit)
    services = [
        _service("Test_SimulationTime"),
        _service("TaskManagerService"),
        _service("AutomationRequestValidatorService"),
        _service("RouteAggregatorService"),
        _service("RoutePlannerVisibilityService"),
        _service("AssignmentTreeBranchBoundService", search),
        _service("PlanBuilderService", TURN),
        *(
            _service("WaypointPlanManagerService", {"VehicleID": str(vehicle.id), **TURN})
            for vehicle in mission.vehicles
        ),
    ]
    if instances:
        services.append(
            _service(
                "IcarousCommunicationService",
                {
                    "NumberOfUAVs": str(len(instances)),
                    "VehicleIDs": " ".join(map(str, instances)),
                    "Address": f"tcp://127.0.0.1:{ports.icarous}",
                    "Timeout_s": str(STARTS_S),
                    # a way that was left is joined again where it was left: nothing is skipped
                    "DeviationAllowed": "0",
                    "DeviationOrigin": "path",
                },
            )
        )
    sent = f'    <Message MessageFileName="{MESSAGES}" SendTime_ms="0"/>\n'
    text = (
        f'<UxAS FormatVersion="1.0" EntityID="{ENTITY}" EntityType="Aircraft" '
        'ConsoleLoggerSeverityLevel="INFO">\n'
        + _bridge(ports.simulator, "FALSE", TO_SIMULATOR)
        # a recorder that does not read loses nothing in silence: its connection ends
        + _bridge(ports.recorder, "TRUE", TO_RECORDER, ' WhenFull="Close"')
        + "".join(services)
        + f'  <Service Type="SendMessagesService" PathToMessageFiles=".">\n{sent}  </Service>\n'
        "</UxAS>\n"
    )
    return _written(folder / CONFIGURATION, text)


def _bridge(port: int, server: str, topics: Sequence[str], more: str = "") -> str:
    asked = "".join(f'    <SubscribeToMessage MessageType="{topic}"/>\n' for topic in topics)
    return (
        f'  <Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="tcp://127.0.0.1:{port}" '
        f'Server="{server}"{more}>\n{asked}  </Bridge>\n'
    )


def _service(kind: str, attributes: dict[str, str] | None = None) -> str:
    said = "".join(f" {name}={quoteattr(value)}" for name, value in (attributes or {}).items())
    return f'  <Service Type="{kind}"{said}/>\n'


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _written(path: Path, text: str) -> Path:
    write_atomically(path, text, f"the file {path.name} for the processes")
    return path
