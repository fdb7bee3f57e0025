"""G5 with a lost-link procedure: that it began in time, and that nothing else was flown.

What each ICAROUS reported (`LinkLossState`) is checked against the kernel `loss_step`: each mode
must follow from the one before. A mode has to begin within a heartbeat after the silence exceeds
its limit; a connection down for longer without a report is a violation. With injected faults that
lose or delay lines of UxAS, the log does not show whether UxAS was heard in between, so whether
enough was reported is unknown. A vehicle that reports a landing has to be on a landing site, to
stay and be at rest there; a vehicle that is there has to report it. For a vehicle that may land and
was not observed throughout this is unknown.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.link_loss import (
    FINISH,
    LAND,
    LANDED,
    LINKED,
    LOITER,
    RETURN,
    Loss,
    loss_step,
)
from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.landing import on_ground
from cratous.core.kernel import qualified
from cratous.core.schedule.rows import runs_forward
from cratous.services.mission.landing import on_failure_of, sites_of
from cratous.services.monitor.landing import Down
from cratous.services.monitor.observation import Ending, Presence, Span
from cratous.services.monitor.required_rows import alone_without_link_item
from cratous.spec.mission import FaultySimulation, Mission, Simulation
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.link_loss import WithoutLink

NUMBERS = {
    WithoutLink.FINISH: FINISH,
    WithoutLink.LOITER: LOITER,
    WithoutLink.RETURN: RETURN,
    WithoutLink.LAND: LAND,
}
LATEST_BEATS = 2
"""Heartbeats until a closed connection is noticed: one to notice it, one for the last line."""
EITHER = (False, True)
NO_LOSS = Loss(LINKED, 0)


@dataclass
class Told:
    """State of one vehicle. loss: last reported; said: (what it flew, since when) in words; wrong:
    faults with their times [ms]; down_ms: time at which its connection ended [ms], None while it is
    up; margin_ms: least time margin when a mode began [ms]; failed_ms: time at which it declared a failure [ms], None
    for none: what it flies since then is judged in the row on that.
    """

    loss: Loss = NO_LOSS
    said: list[str] = field(default_factory=list)
    wrong: list[tuple[int, str]] = field(default_factory=list)
    down_ms: int | None = None
    margin_ms: int | None = None
    checks: int = 0
    failed_ms: int | None = None


def _may_not_come(simulation: Simulation) -> bool:
    """Whether injected faults may drop or delay lines of UxAS while a connection is up."""
    if not isinstance(simulation, FaultySimulation):
        return False
    faults = simulation.bridge_faults
    asked = (faults.loss, faults.truncation, faults.corruption, faults.delay_ms)
    return any(asked) or faults.stops_reading_ms is not None


class LinkLossWatch:
    """What vehicles with an ICAROUS instance flew without the link; empty if the mission has no procedure."""

    def __init__(self, mission: Mission, down: Mapping[int, Down], presence: Presence) -> None:
        """down: vehicles on the ground, by their positions; presence: observation spans of each aircraft."""
        self._down, self._presence, self._lands = down, presence, bool(sites_of(mission))
        self._end_ms = 0
        self._asked, self._beat_ms = mission.link_loss, mission.simulation.heartbeat_ms
        there = mission.instances if self._asked is not None else ()
        self._told = {number: Told() for number in there}
        self._may_fail = on_failure_of(mission) is not None
        self._over = False
        self._known_heard = not _may_not_come(mission.simulation)

    def state(self, body: Any) -> None:
        """Process a LinkLossState: what a vehicle flies from now on."""
        told = self._told.get(body.VehicleID)
        if told is None or self._asked is None or told.failed_ms is not None:
            return
        told.checks += 1
        now_ms, heard_ms, after_ms = body.Time, body.Heard, self._asked.after_ms
        mode, chosen = int(body.Mode), NUMBERS[self._asked.choice]
        if told.loss.mode == LINKED:
            left_ms = heard_ms + after_ms + self._beat_ms - now_ms
            told.margin_ms = left_ms if told.margin_ms is None else min(told.margin_ms, left_ms)
            if not in_time(heard_ms + after_ms, now_ms, self._beat_ms):
                text = f"began {(now_ms - heard_ms) / 1000:g} s after UxAS was last heard"
                told.wrong.append((now_ms, text))
        may = {
            loss_step(told.loss, chosen, heard_ms, now_ms, after_ms, way, end).loss.mode
            for way in EITHER
            for end in EITHER
        }
        if mode not in may or mode == told.loss.mode or int(body.Chosen) != chosen:
            was = body.Mode.name
            told.wrong.append((now_ms, f"{was} is not what follows then"))
        told.loss = Loss(mode, now_ms)
        told.said.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s")

    def declared(self, body: Any) -> None:
        """Process a FailureState: this row ends here."""
        told = self._told.get(body.VehicleID)
        if told is None or not self._may_fail or told.failed_ms is not None:
            return
        self._missed(told, body.Time)
        told.failed_ms = body.Time
        told.said.append(f"a failure declared at {body.Time / 1000:.2f} s")

    def status(self, body: Any) -> None:
        """Process a BridgeStatus: UxAS's end reports that a connection is open or has ended."""
        told = self._told.get(body.VehicleID)
        if told is None:
            return
        if body.Alive:
            self._missed(told, body.Time)
            told.down_ms = None
        elif told.down_ms is None and body.Note.startswith("link lost"):
            told.down_ms = body.Time

    def end(self, body: Any) -> None:
        """Process MissionEnd: the messages are complete."""
        self._over, self._end_ms = True, body.Time
        for vehicle, told in self._told.items():
            self._missed(told, body.Time)
            judged = told.failed_ms is None
            if judged and (text := self._on_the_ground(vehicle, told, body.Time)):
                told.wrong.append((body.Time, text))

    def _on_the_ground(self, vehicle: int, told: Told, now_ms: int) -> str:
        """Fault of a vehicle's landing, or of a missing one; empty if none."""
        down, said = self._down.get(vehicle), told.loss.mode == LANDED
        said_ms = told.loss.since_ms
        if down is None:
            known = said and not self._unseen(vehicle, (said_ms, said_ms + self._presence.step_ms))
            return "it said that it had landed, and was in the air" if known else ""
        if not down.site:
            return "it came to the ground beside every landing site"
        if fault := down.taken or down.wrong:
            return f"{down.words()}, and {fault}"
        early = said and not runs_forward(down.since_ms, said_ms)
        if early and not self._unseen(vehicle, (said_ms, down.since_ms)):
            return f"it said that it had landed before it {down.words()}"
        if not down.stands:
            # unknown for a vehicle that was not observed to the end
            if self._unseen(vehicle, (down.since_ms, now_ms)):
                return ""
            return f"{down.words()}, and did not stand there at the end"
        # a landing is reported at the heartbeat after touchdown
        if not said and not in_time(down.since_ms, now_ms, LATEST_BEATS * self._beat_ms):
            return f"{down.words()}, and did not say so"
        return ""

    def _unseen(self, vehicle: int, span: Span) -> str:
        """Observation gaps of a vehicle that may land, in words; empty if none."""
        return self._presence.unseen(vehicle, span, Ending(span[1], True)) if self._lands else ""

    def _missed(self, told: Told, now_ms: int) -> None:
        """Record a fault if a connection has been down for so long that a report was due."""
        if told.down_ms is None or told.loss.mode != LINKED or self._asked is None:
            return
        if told.failed_ms is not None:
            return
        bound_ms = self._asked.after_ms + LATEST_BEATS * self._beat_ms
        since = told.loss.since_ms
        # a mode that ended after the connection did has been reported
        if not in_time(max(told.down_ms, since), now_ms, bound_ms):
            text = f"the link was down since {told.down_ms / 1000:.2f} s, and it did nothing"
            told.wrong.append((now_ms, text))

    def verdicts(self) -> list[Verdict]:
        """One verdict per vehicle."""
        return [self._verdict(number, told) for number, told in sorted(self._told.items())]

    def _verdict(self, vehicle: int, told: Told) -> Verdict:
        outcome, note, at_ms = Outcome.HOLDS, ", ".join(told.said), None
        down = self._down.get(vehicle)
        if down is not None:
            note = f"{note}; {down.words()}" if note else down.words()
        if told.wrong:
            outcome, (at_ms, text) = Outcome.VIOLATED, told.wrong[0]
            note = f"{text}; {note}" if note else text
        elif not self._over:
            outcome = Outcome.UNKNOWN
            note = f"{note}; the messages stop too early" if note else "the messages stop too early"
        elif not self._known_heard:
            outcome = Outcome.UNKNOWN
            note = f"{note}; " if note else ""
            note += "over a bridge that was made to fail: whether UxAS was heard is not logged"
        elif unseen := self._unseen(vehicle, (0, self._end_ms)):
            outcome, note = Outcome.UNKNOWN, f"{note}; {unseen}" if note else unseen
        elif not note:
            note = "it was never without the link for long enough"
        asked: list[Any] = [loss_step, in_time] if told.checks else []
        kernels = tuple(
            qualified(kernel) for kernel in [*asked, *([on_ground, runs_forward] if down else [])]
        )
        margin = None if told.margin_ms is None else told.margin_ms / 1000
        return Verdict(
            "G5", alone_without_link_item(vehicle), outcome, Kind.OBSERVED, note,
            time_ms=at_ms, vehicles=(vehicle,), margin=margin,
            unit="s" if margin is not None else "", checks=told.checks, kernels=kernels,
        )  # fmt: skip
