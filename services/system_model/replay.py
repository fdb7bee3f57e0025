"""Replays a log through the composed steps, event by event, until one does not fit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.timeliness import in_time, lasted
from cratous.services.system_model.finding import Finding, Misfit
from cratous.services.system_model.vehicle import HAND, REPORTS, VehicleModel
from cratous.spec.mission import FaultySimulation, Mission

LOOKED_AT = (
    *REPORTS,
    HAND,
    "GatedCommand",
    "Heartbeat",
    "BridgeStatus",
    "ModeRefused",
    "MissionEnd",
)
SUSPENDED = "Suspended"


@dataclass
class Replayed:
    """events: number of events that were steps, by kind; passed: unchecked messages by topic;
    vehicles: number with an ICAROUS instance; finding: the first event that does not fit, None if
    all do.
    """

    vehicles: int
    events: Counter[str] = field(default_factory=Counter)
    passed: Counter[str] = field(default_factory=Counter)
    finding: Finding | None = None


class _Replay:
    def __init__(self, mission: Mission, avoidance: bool) -> None:
        instances = frozenset(mission.instances if avoidance else ())
        beat_ms = mission.simulation.heartbeat_ms
        self.models = {
            v.id: VehicleModel(v.id, v.id in instances, beat_ms) for v in mission.vehicles
        }
        self.heartbeat_ms, self.simulation = beat_ms, mission.simulation
        self.limit_ms = mission.simulation.limit_ms + mission.simulation.step_ms
        self.result = Replayed(len(instances))
        self.now_ms, self.seq, self.vehicle_id, self.over = 0, 0, 0, False
        self.told: set[int] = set()

    def message(self, envelope: Any) -> None:
        """Process one message of the log."""
        self.vehicle_id = 0
        self._time(envelope.time_ms)
        self.seq = envelope.seq
        short = envelope.topic.rpartition(".")[2]
        body = envelope.body
        left = short == "TaskProgress" and body.Phase.name == SUSPENDED
        if short not in LOOKED_AT and not left:
            self.result.passed[envelope.topic] += 1
            return
        self.result.events[short] += 1
        if self.over:
            raise Misfit(short, "nothing after the end of the mission", short)
        if not in_time(getattr(body, "Time", self.now_ms), self.now_ms, 0):
            raise Misfit(short, f"the time of its message, {self.now_ms} ms", f"{body.Time} ms")
        if short == "MissionEnd":
            self.over = True
            return
        self.vehicle_id = body.VehicleID
        model = self.models.get(body.VehicleID)
        if model is None:
            ids = ", ".join(map(str, self.models))
            raise Misfit(short, f"a vehicle of the mission: {ids}", str(body.VehicleID))
        if short == "Heartbeat" and body.Direction.name == "Down":
            self._due_now(short)
            self.told.add(body.VehicleID)
        model.event(short, envelope.source, body, self.now_ms)

    def end(self) -> None:
        """Process the end of the log."""
        self.vehicle_id = 0
        self._close()
        if not self.over:
            raise Misfit("the end of the log", "the end of the mission", "no MissionEnd")

    def _time(self, time_ms: int) -> None:
        """Advance the time: the heartbeats before it are complete."""
        if not in_time(self.now_ms, time_ms, self.limit_ms) or not in_time(
            0, time_ms, self.limit_ms
        ):
            expected = f"a time from {self.now_ms} to {self.limit_ms} ms, where a flight has ended"
            raise Misfit("the time of a message", expected, f"{time_ms} ms")
        if not lasted(self.now_ms, time_ms, 1):
            return
        self._close()
        following = self.now_ms - self.now_ms % self.heartbeat_ms + self.heartbeat_ms
        for skipped in range(following, time_ms, self.heartbeat_ms):
            self.now_ms = skipped
            self._close()
        self.now_ms = time_ms

    def _close(self) -> None:
        """Close an instant: no report may be due, and at a heartbeat every vehicle must have had one."""
        beats = self.now_ms % self.heartbeat_ms == 0
        for vehicle_id, model in self.models.items():
            self.vehicle_id = vehicle_id
            model.nothing_due("none")
            if beats:
                if model.icarous is not None and model.uxas.open and vehicle_id not in self.told:
                    number = f"number {model.uxas.downs + 1}"
                    raise Misfit("a heartbeat to ICAROUS", f"{number} at {self.now_ms} ms", "none")
                model.end_of_heartbeat(self.now_ms, self._stands_still())
        self.told.clear()

    def _stands_still(self) -> bool:
        """Whether the mission lets ICAROUS stop now."""
        if not isinstance(self.simulation, FaultySimulation):
            return False
        return self.simulation.bridge_faults.icarous_is_silent(self.now_ms)

    def _due_now(self, short: str) -> None:
        if self.now_ms % self.heartbeat_ms != 0 or self.vehicle_id in self.told:
            expected = f"one at each multiple of {self.heartbeat_ms} ms"
            raise Misfit(short, expected, f"one at {self.now_ms} ms")


def replay(mission: Mission, avoidance: bool, envelopes: Iterable[Any]) -> Replayed:
    """Check the messages of one flight against the model. avoidance: it was flown with ICAROUS instances."""
    steps = _Replay(mission, avoidance)
    try:
        for envelope in envelopes:
            steps.seq = envelope.seq
            steps.message(envelope)
        steps.end()
    except Misfit as wrong:
        place = (steps.seq, steps.now_ms, steps.vehicle_id)
        steps.result.finding = Finding(*place, wrong.what, wrong.expected, wrong.got)
    return steps.result
