"""Input files of the processes: the simulator's scenario, and configuration and messages of UxAS."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from cratous.core.files.whole_file import write_atomically
from cratous.services.exporting.amase import scenario_text
from cratous.services.exporting.messages import Told
from cratous.services.exporting.uxas import (
    CONFIGURATION,
    MESSAGES,
    configuration_text,
    messages_text,
)
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission

SCENARIO = "scenario.xml"
SETS_OUT_S = 0.45
"""When all aircraft are present [s]: just before the simulator's first states."""
LINGERS_S = 600.0
"""The scenario continues for this long after the mission's limit, which the command itself monitors [s]."""
STARTS_S = 900
"""How long UxAS and the ICAROUS instances wait for each other, since all check the proofs first [s]."""
TO_RECORDER = (
    "afrl.cmasi.AutomationResponse",
    "afrl.cmasi.MissionCommand",
    "afrl.cmasi.VehicleActionCommand",
    "afrl.cmasi.ServiceStatus",
    "uxas.messages.task.",
    "cratous.",
)
TO_SIMULATOR = ("afrl.cmasi.MissionCommand", "afrl.cmasi.VehicleActionCommand")


ORIGINAL_PORT = 5557
"""Port at which the original's clients connect to UxAS, on this machine."""
CLIENTS_S = 300
"""How long UxAS waits for them [s]."""


class Ports(NamedTuple):
    """Loopback ports: of the simulator, of UxAS for the recorder, and for the ICAROUS instances."""

    simulator: int
    recorder: int
    icarous: int


def write_scenario(mission: Mission, told: Told, folder: Path) -> Path:
    """Write the simulator's scenario: vehicles and traffic with the times at which they appear."""
    duration_s = mission.simulation.limit_ms / 1000 + LINGERS_S
    return _written(folder / SCENARIO, scenario_text(mission, told, duration_s, SETS_OUT_S))


def write_messages(told: Told, folder: Path) -> Path:
    """Write all messages sent to UxAS to one file, in order."""
    return _written(folder / MESSAGES, messages_text(told))


def write_configuration(
    mission: Mission, instances: Sequence[int], ports: Ports, folder: Path, original: bool = False
) -> Path:
    """Write the configuration of UxAS: bridges, planning services, a waypoint manager per vehicle, ICAROUS.

    original: ICAROUS runs behind clients of the original's, without keys; otherwise both ends authenticate
    each other.
    """
    communication = {
        "Address": f"tcp://127.0.0.1:{ports.icarous}",
        "Timeout_s": str(STARTS_S),
        # an interrupted route is rejoined where it was left, so nothing is skipped
        "DeviationAllowed": "0",
        "DeviationOrigin": "path",
    }
    if original:
        communication |= {"Dialect": "original", "Timeout_s": str(CLIENTS_S)}
    else:  # the keys are in the environment
        communication |= {"Dialect": "v2"}
    if mission.live_planning:
        if original:
            raise BadInput(
                "the original's clients cannot ask UxAS",
                where=mission.source,
                item="bridge.uxas_route_planner",
                expected="false, or no --original-clients",
                got="true",
            )
        communication["UseUxasRoutePlanner"] = "true"
    bridges = (
        _bridge(ports.simulator, "FALSE", TO_SIMULATOR)
        # a slow recorder loses its connection instead of messages; only one client may connect
        + _bridge(ports.recorder, "TRUE", TO_RECORDER, ' WhenFull="Close" MaxConnections="1"')
    )
    clock = ("Test_SimulationTime",)
    text = configuration_text(mission, instances, communication, bridges, clock)
    return _written(folder / CONFIGURATION, text)


def _bridge(port: int, server: str, topics: Sequence[str], more: str = "") -> str:
    asked = "".join(f'    <SubscribeToMessage MessageType="{topic}"/>\n' for topic in topics)
    return (
        f'  <Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="tcp://127.0.0.1:{port}" '
        f'Server="{server}"{more}>\n{asked}  </Bridge>\n'
    )


def _written(path: Path, text: str) -> Path:
    write_atomically(path, text, f"the file {path.name} for the processes")
    return path
