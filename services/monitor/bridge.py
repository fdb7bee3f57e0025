"""G5: heartbeats in both directions at their period, for every protected vehicle.

The fold `beats_in_time` decides that none was late; the longest gap is kept for the note. A
duplicate or out-of-order heartbeat is no sign of life. If none came at all, the silence lasts from
start to end; for an ICAROUS whose protocol has no heartbeats the verdict is unknown. Downlink
messages are logged when UxAS sends them: with injected bridge faults their arrival is not known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.core.authority.replay import packet_is_new
from cratous.core.authority.timeliness import Beats, beats_in_time, beats_result
from cratous.core.kernel import qualified
from cratous.services.monitor.required_rows import WAYS, beat_item
from cratous.spec.mission import FaultySimulation, Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

PERIODS = 2
"""A heartbeat is late when it has not come after this many periods."""
ANY_LATER = 2**60
"""Bound for `beats_in_time` on sequence numbers: any number of lost heartbeats may lie between two."""


NONE: tuple[str, ...] = ()


@dataclass
class Beat:
    """Heartbeats of one vehicle in one direction."""

    bound_ms: int
    count: int = 0
    longest_ms: int = 0
    at_ms: int = 0
    beats: Beats = beats_in_time.start
    number: int = 0

    def come(self, time_ms: int, number: int) -> None:
        """Process a heartbeat with its sequence number (from 1)."""
        self.count += 1
        if packet_is_new(self.number, number, ANY_LATER):
            self.number = number
            self._add(time_ms)

    def end(self, time_ms: int) -> None:
        """Process the end of the mission: the time since the last heartbeat counts too."""
        self._add(time_ms)

    def _add(self, time_ms: int) -> None:
        gap = time_ms - self.beats.last
        if gap > self.longest_ms:
            self.longest_ms, self.at_ms = gap, time_ms
        self.beats = beats_in_time.step(self.beats, time_ms, self.bound_ms)

    @property
    def in_time(self) -> bool:
        """True if no heartbeat has been late so far."""
        return bool(beats_result(self.beats))


class BridgeWatch:
    """Liveness of the bridge of every protected vehicle. says_beats: whether the ICAROUS protocol
    has heartbeats.
    """

    def __init__(self, mission: Mission, says_beats: bool = True) -> None:
        self._says_beats = says_beats
        self._bound_ms = PERIODS * mission.simulation.heartbeat_ms
        self._instances = set(mission.instances)
        self._faulty = isinstance(mission.simulation, FaultySimulation)
        self._beats = {
            (v.id, way): Beat(self._bound_ms)
            for v in mission.vehicles
            if v.protected
            for way in WAYS
        }
        self._downs: dict[int, str] = {}
        self._end_ms: int | None = None

    def heartbeat(self, body: Any) -> None:
        """Process a Heartbeat."""
        beat = self._beats.get((body.VehicleID, body.Direction.name))
        if beat is not None:
            beat.come(body.Time, body.Sequence)

    def status(self, body: Any) -> None:
        """Process a BridgeStatus: the bridge reports whether it is alive."""
        if not body.Alive and body.VehicleID not in self._downs:
            self._downs[body.VehicleID] = f"down at {body.Time / 1000:.2f} s: {body.Note}"

    def end(self, body: Any) -> None:
        """Process MissionEnd: the messages are complete."""
        self._end_ms = body.Time
        for beat in self._beats.values():
            beat.end(body.Time)

    def verdicts(self) -> list[Verdict]:
        """One verdict per protected vehicle and direction."""
        return [self._verdict(*key, beat) for key, beat in sorted(self._beats.items())]

    def _verdict(self, vehicle: int, way: str, beat: Beat) -> Verdict:
        margin: float | None = (self._bound_ms - beat.longest_ms) / 1000
        note = f"{beat.count} heartbeats, longest gap {beat.longest_ms / 1000:.2f} s"
        outcome = Outcome.HOLDS if beat.in_time else Outcome.VIOLATED
        kernels: tuple[str, ...] = tuple(map(qualified, (packet_is_new, *beats_in_time.kernels)))
        if vehicle not in self._instances:
            outcome, margin, kernels = Outcome.UNKNOWN, None, NONE
            note = "the vehicle has no ICAROUS instance: there is no bridge to judge"
        elif self._end_ms is None:
            outcome, margin, kernels = Outcome.UNKNOWN, None, NONE
            note = "no heartbeat seen" if not beat.count else "the messages stop too early"
        elif vehicle in self._downs:
            outcome, kernels = Outcome.VIOLATED, NONE
            note = self._downs[vehicle]
        elif not beat.count:
            note = "no heartbeat seen"
            if way == "Up" and not self._says_beats:
                outcome, note = Outcome.UNKNOWN, f"{note}: its protocol has none"
            elif outcome is Outcome.HOLDS:  # the mission ended before a heartbeat could be late
                outcome = Outcome.UNKNOWN
            if outcome is Outcome.UNKNOWN:
                margin, kernels = None, NONE
        elif self._faulty and way == "Down" and outcome is Outcome.HOLDS:
            outcome, margin, kernels = Outcome.UNKNOWN, None, NONE
            note = f"{note}; these were sent, over a bridge that was made to fail: whether they came is not logged"
        return Verdict(
            "G5",
            beat_item(vehicle, way),
            outcome,
            Kind.OBSERVED,
            note,
            time_ms=beat.at_ms if beat.count else 0,
            vehicles=(vehicle,),
            margin=margin,
            unit="s" if margin is not None else "",
            checks=beat.count,
            kernels=kernels,
        )
