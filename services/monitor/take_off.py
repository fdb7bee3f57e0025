"""G4 of a vehicle that starts on the ground: that it leaves it under ICAROUS, by a roll that was said to be permitted.

By where it was and what its ICAROUS said of it (`TakeOffState`), held against the kernel `departure_step`: from the mode
before, the one that it told must follow, whatever was permitted. On the ground it moves only while its gate has ICAROUS
command, is faster only while it is said to roll, and leaves it out of such a roll, which is said within two heartbeats.
Of what was not seen nothing is said: not that it was wrong, and not that it was as it should.
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
"""So many heartbeats after it is off the ground it has been said."""
ROUNDED_M = 1e-3
"""Positions are sums of rounded steps: a leg that is longer than the one before by no more is as long [m]."""
EITHER = (False, True)


@dataclass
class Seen:
    """One vehicle: said: its modes, since when [ms]; icarous: whether it is ICAROUS that commands, since when [ms]; leg_m:
    how far it was flown along the ground in the last step that was seen, which ended at leg_ms [ms]; off_ms: when it was
    last on the ground, as far as was seen, None as long as it is; wrong: what should not have been, with the time [ms]."""

    said: list[tuple[int, int]] = field(default_factory=lambda: [(0, STANDING)])
    icarous: list[tuple[int, bool]] = field(default_factory=lambda: [(0, False)])
    leg_m: float = 0.0
    leg_ms: int = 0
    off_ms: int | None = None
    wrong: list[tuple[int, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    checks: int = 0


def _at(history: list[tuple[int, Any]], time_ms: int) -> Any:
    """What was so at an instant, by its changes."""
    return next(value for since_ms, value in reversed(history) if lasted(since_ms, time_ms, 0))


class TakeOffWatch:
    """The vehicles with an ICAROUS instance that start on the ground; nobody where the mission has none."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._presence, self._beat_ms = presence, mission.simulation.heartbeat_ms
        self._silence_ms, self._lands = silence_ms(mission), bool(sites_of(mission))
        there = [one for one in grounded(mission) if one.id in mission.instances]
        self._vehicles: dict[int, GroundedVehicle] = {one.id: one for one in there}
        self._seen = {number: Seen() for number in self._vehicles}
        self._end_ms: int | None = None

    def state(self, body: Any) -> None:
        """Take a vehicle's take-off state."""
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
        # why it stands may be said again
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
        """Two successive instants."""
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
            return  # how it moved was not seen, or it had left the ground before it was
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
        """The mission ended."""
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
        """What was not seen of a vehicle between two instants; empty if all was."""
        return self._presence.unseen(number, span, Ending(span[1], True))

    def verdicts(self) -> list[Verdict]:
        """One verdict a vehicle."""
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
