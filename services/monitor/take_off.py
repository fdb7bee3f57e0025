"""G4 for a vehicle that starts on the ground: it takes off under ICAROUS, in a roll reported as
permitted.

The vehicle's positions and the states that its ICAROUS reported (`TakeOffState`) are checked
against the kernel `departure_step`: each reported mode must follow from the one before. On the
ground it moves only while its gate gives ICAROUS command, accelerates only while a roll is
reported, and lifts off only out of such a roll, which is reported within two heartbeats. Nothing is
claimed about unobserved periods.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.take_off import (
    CLIMBING,
    ROLLING,
    STANDING,
    Departure,
    departure_step,
)
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.landing import on_ground
from cratous.core.kernel import Vec2, qualified
from cratous.core.permit.tubes import disc_within
from cratous.core.readings.exact import exact
from cratous.services.assumptions.authority import has_it, reported
from cratous.services.mission.landing import is_down, sites_of
from cratous.services.mission.take_off import grounded, silence_ms
from cratous.services.monitor.observation import Ending, Presence, Span
from cratous.services.monitor.required_rows import take_off_item
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import GroundedVehicle, Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

LATEST_BEATS = 2
"""Heartbeats after lift-off within which it has to be reported."""
ROUNDED_M = 1e-3
"""Tolerance on a leg's length [m]: positions are sums of rounded steps, so a smaller increase is none."""
EITHER = (False, True)


@dataclass
class Seen:
    """One vehicle. said: its modes with times [ms]; icarous: changes of ICAROUS's command with
    times [ms]; leg_m: distance along the ground in the last observed step, which ended at leg_ms
    [ms]; off_ms: time of the last observation on the ground, None while on it; wrong: faults with
    their times [ms].
    """

    said: list[tuple[int, int]] = field(default_factory=lambda: [(0, STANDING)])
    icarous: list[tuple[int, bool]] = field(default_factory=lambda: [(0, False)])
    leg_m: float = 0.0
    leg_ms: int = 0
    off_ms: int | None = None
    wrong: list[tuple[int, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    checks: int = 0


def _at(history: list[tuple[int, Any]], time_ms: int) -> Any:
    """The value at an instant, from its history of changes."""
    return next(value for since_ms, value in reversed(history) if lasted(since_ms, time_ms, 0))


class TakeOffWatch:
    """Watches vehicles with an ICAROUS instance that start on the ground; empty if the mission has none."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._presence, self._beat_ms = presence, mission.simulation.heartbeat_ms
        self._silence_ms, self._lands = silence_ms(mission), bool(sites_of(mission))
        there = [one for one in grounded(mission) if one.id in mission.instances]
        self._vehicles: dict[int, GroundedVehicle] = {one.id: one for one in there}
        self._seen = {number: Seen() for number in self._vehicles}
        self._end_ms: int | None = None

    def state(self, body: Any) -> None:
        """Process a vehicle's TakeOffState."""
        seen = self._seen.get(body.VehicleID)
        if seen is None:
            return
        seen.checks += 1
        now_ms, mode = body.Time, int(body.Mode)
        since_ms, before = seen.said[-1]
        may = {
            departure_step(
                Departure(before, since_ms), body.Heard, now_ms, self._silence_ms, way, air, end
            ).departure.mode
            for way in EITHER
            for air in EITHER
            for end in EITHER
        }
        # the reason for standing may be reported repeatedly
        if mode not in may or (mode == before and mode != STANDING):
            seen.wrong.append((now_ms, f"{body.Mode.name} is not what follows then"))
        if mode != before:
            seen.said.append((now_ms, mode))
            seen.notes.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s")

    def gate(self, body: Any) -> None:
        """Process a GateState."""
        seen = self._seen.get(body.VehicleID)
        if seen is not None:
            seen.icarous.append((body.Time, has_it(reported(body))))

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Process two successive samples of the aircraft."""
        for number, vehicle in self._vehicles.items():
            if number in before and number in after:
                self._leg(self._seen[number], vehicle, before[number], after[number])

    def _leg(self, seen: Seen, vehicle: GroundedVehicle, before: Sample, after: Sample) -> None:
        at_ms, here, there = before.time_ms, before.position, after.position
        was_down, down = (is_down(one.alt_m - vehicle.ground_m) for one in (here, there))
        if seen.off_ms is not None:
            if down and not self._lands:
                seen.wrong.append((after.time_ms, "it came to the ground again"))
            return
        seen.checks += 1
        if not down:
            seen.off_ms = at_ms
        whole = in_time(at_ms, after.time_ms, self._presence.step_ms)
        if not whole or not (was_down or in_time(0, at_ms, 0)):
            return  # its motion was not observed, or it had already left the ground
        moved = Vec2(there.north_m - here.north_m, there.east_m - here.east_m)
        mode, still = _at(seen.said, at_ms), disc_within(moved, 0.0, 0.0)
        rolls = mode == ROLLING
        if not still and not _at(seen.icarous, at_ms):
            seen.wrong.append((at_ms, "it moved on the ground while UxAS had it"))
        slower = exact(disc_within, moved, 0.0, seen.leg_m + ROUNDED_M)
        if in_time(seen.leg_ms, at_ms, 0) and not rolls and not slower:
            seen.wrong.append((at_ms, "it rolled faster and was not said to roll"))
        seen.leg_m = (moved.x * moved.x + moved.y * moved.y) ** 0.5
        seen.leg_ms = after.time_ms
        if not down and not rolls:
            seen.wrong.append((at_ms, "it left the ground and was not said to roll"))

    def end(self, body: Any) -> None:
        """Process MissionEnd: the messages are complete."""
        self._end_ms = body.Time
        for number, seen in self._seen.items():
            climbs = next((since for since, mode in seen.said if mode == CLIMBING), None)
            step_ms = self._presence.step_ms
            if climbs is not None and seen.off_ms is None:
                if not self._unseen(number, (climbs, climbs + step_ms)):
                    text = "it said that it had left the ground, and was on it"
                    seen.wrong.append((climbs, text))
            elif seen.off_ms is not None and not self._unseen(number, (0, seen.off_ms + step_ms)):
                said_ms = body.Time if climbs is None else climbs
                if not in_time(seen.off_ms, said_ms, LATEST_BEATS * self._beat_ms):
                    text = f"it left the ground at {seen.off_ms / 1000:.2f} s"
                    seen.wrong.append((seen.off_ms, f"{text}, and did not say so then"))

    def _unseen(self, number: int, span: Span) -> str:
        """Observation gaps of a vehicle between two instants, in words; empty if none."""
        return self._presence.unseen(number, span, Ending(span[1], True))

    def verdicts(self) -> list[Verdict]:
        """One verdict per vehicle."""
        return [self._verdict(number, seen) for number, seen in sorted(self._seen.items())]

    def _verdict(self, vehicle: int, seen: Seen) -> Verdict:
        outcome, note, at_ms = Outcome.HOLDS, ", ".join(seen.notes), seen.off_ms
        where = "it stayed on the ground"
        if seen.off_ms is not None:
            where = f"off the ground at {seen.off_ms / 1000:.2f} s"
        note = f"{where}; {note}" if note else where
        unseen = "" if self._end_ms is None else self._unseen(vehicle, (0, self._end_ms))
        if seen.wrong:
            outcome, (at_ms, text) = Outcome.VIOLATED, seen.wrong[0]
            note = f"{text}; {note}"
        elif self._end_ms is None:
            outcome, note = Outcome.UNKNOWN, f"{note}; the messages stop too early"
        elif unseen:
            outcome, note = Outcome.UNKNOWN, f"{note}; {unseen}"
        asked: list[Any] = [departure_step, disc_within, in_time, on_ground] if seen.checks else []
        return Verdict(
            "G4", take_off_item(vehicle), outcome, Kind.OBSERVED, note, time_ms=at_ms,
            vehicles=(vehicle,), checks=seen.checks, method="departure_step",
            kernels=tuple(sorted(map(qualified, asked))),
        )  # fmt: skip
