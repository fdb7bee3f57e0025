"""The virtual time of a mission, and its simulated faults."""

from __future__ import annotations

from dataclasses import dataclass, field

from cratous.spec.mission.bridge_faults import BridgeFaults


@dataclass(frozen=True)
class Simulation:
    """Virtual time: length of a physics step, heartbeat period, and time limit of the flight."""

    step_ms: int = 250
    heartbeat_ms: int = 500
    limit_ms: int = 7_200_000


@dataclass(frozen=True)
class FaultySimulation(Simulation):
    """A simulation with faults of the bridge."""

    bridge_faults: BridgeFaults = field(default_factory=BridgeFaults)
