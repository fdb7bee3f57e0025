"""G4 after a declared failure: that it may be declared, what is flown then, and that UxAS does not get the vehicle back.

A failure (`FailureState`) must follow from the kernel `failure_step` for what the messages show: a
task given up before (`blocked`), certificates missing for four heartbeats (`expiring`,
`surprised`). What each ICAROUS reports to fly then (`LinkLossState`) is checked against the kernel
`loss_step`, with UxAS as never heard again, and a landing as in `services.monitor.link_loss`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

from cratous.core.authority.failure import Asked, Failure, Seen, failure_step, heard_by
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts
from cratous.core.authority.link_loss import FINISH, LAND, LINKED, LOITER, RETURN, Loss, loss_step
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.landing import on_ground
from cratous.core.kernel import qualified
from cratous.services.assumptions.authority import reported
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.merging import merging_of
from cratous.services.monitor.landing import Down
from cratous.services.monitor.link_loss import EITHER, NO_LOSS, LinkLossWatch
from cratous.services.monitor.link_loss import Told as Flown
from cratous.services.monitor.observation import Presence
from cratous.services.monitor.required_rows import failure_item
from cratous.spec.authority.failure import BLOCKED, NONE
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.on_failure import AfterFailure, Failed

NUMBERS = {
    AfterFailure.HOLD: LOITER,
    AfterFailure.RETURN: RETURN,
    AfterFailure.LAND: LAND,
    AfterFailure.DITCH: LAND,
}
RESERVE_BEATS = 4
"""Number of heartbeats that a certificate must cover; a test compares it with the instance's value."""
BOUND_MS = 2**40
"""No silence counts: only a declared failure does [ms]."""
BLOCKED_NOTE = "blocked: "
NO_FAILURE = Failure(NONE, 0)
UNTOUCHED = Gate(UXAS, 0, False)


@dataclass
class Told(Flown):
    """Also: failure: as declared; gate: as last reported; blocked: a task of it has been given up;
    without_ms: since when no certificate was found [ms], None while one is.
    """

    failure: Failure = NO_FAILURE
    gate: Gate = UNTOUCHED
    blocked: bool = False
    without_ms: int | None = None


class FailureWatch(LinkLossWatch):
    """What vehicles with an ICAROUS instance did after a failure; empty if the mission does not ask."""

    def __init__(self, mission: Mission, down: Mapping[int, Down], presence: Presence) -> None:
        """down: vehicles on the ground, by their positions; presence: observation spans of each aircraft."""
        super().__init__(mission, down, presence)
        self._after = on_failure_of(mission)
        self._silent_ms = mission.bridge_times.lost_link_after_ms
        self._merges_or_senses = mission.sensing is not None or merging_of(mission) is not None
        there = mission.instances if self._after is not None else ()
        self._seen = {number: Told() for number in there}
        self._told = dict(self._seen)

    def progress(self, body: Any) -> None:
        """Process a TaskProgress: a task that is given up."""
        told = self._seen.get(body.VehicleID)
        if told is not None and body.Phase.name == "Failed":
            told.blocked |= body.Note.startswith(BLOCKED_NOTE)

    def hand(self, body: Any) -> None:
        """Process a HandState: a certificate, or that there is none."""
        told = self._seen.get(body.VehicleID)
        if told is None:
            return
        if body.Change.name == "Missing" and told.without_ms is None:
            told.without_ms = body.Time
        elif body.Change.name == "Offered":
            told.without_ms = None

    def gate(self, body: Any) -> None:
        """Process a GateState: who commands a vehicle."""
        told = self._seen.get(body.VehicleID)
        if told is None:
            return
        had, told.gate = _flies(told), reported(body)
        if told.failure.kind == NONE:
            return
        if not _flies(told):
            told.wrong.append((body.Time, "UxAS got it back after a declared failure"))
        elif not had and lasted(told.failure.since_ms, body.Time, 1):
            told.wrong.append((body.Time, "ICAROUS got it later than the failure was declared"))

    def declared(self, body: Any) -> None:
        """Process a FailureState."""
        told = self._seen.get(body.VehicleID)
        if told is None or self._after is None:
            return
        told.checks += 1
        now_ms, kind, name = body.Time, int(body.Failure), body.Failure.name.lower()
        asked = Asked(*(one in self._after.of for one in Failed))
        reserve_ms, flies = RESERVE_BEATS * self._beat_ms, _flies(told)
        without, since_ms = told.without_ms is not None, told.without_ms or 0
        may = {
            failure_step(told.failure, asked, seen, told.loss.mode, now_ms, reserve_ms)
            for stopped, surprised in product(EITHER, EITHER)
            for seen in (Seen(stopped, flies, without, since_ms, surprised, now_ms),)
        }
        after = Failure(kind, now_ms)
        # after a failure no other one may follow, and the same one is not declared again
        if after == told.failure or after not in may:
            told.wrong.append((now_ms, f"{name} is not what could be declared then"))
        if kind == BLOCKED and not told.blocked:
            told.wrong.append((now_ms, "blocked is declared, and no task of it was given up"))
        told.failure, told.loss = after, NO_LOSS
        told.said.append(f"{name} at {now_ms / 1000:.2f} s")

    def state(self, body: Any) -> None:
        """Process a LinkLossState: what a vehicle flies from now on."""
        told = self._seen.get(body.VehicleID)
        if told is None or self._after is None:
            return
        told.checks += 1
        now_ms, mode, chosen = body.Time, int(body.Mode), NUMBERS[self._after.choice]
        if told.failure.kind == NONE:
            self._without_link(told, body)
            return
        by = heard_by(told.failure, body.Heard)
        may = {
            loss_step(told.loss, chosen, by, now_ms, BOUND_MS, way, end).loss.mode
            for way in EITHER
            for end in EITHER
        }
        if mode not in may or mode == told.loss.mode or int(body.Chosen) != chosen:
            told.wrong.append((now_ms, f"{body.Mode.name} is not what follows then"))
        if told.loss == NO_LOSS and lasted(told.failure.since_ms, now_ms, 1):
            told.wrong.append((now_ms, "it began later than the failure was declared"))
        told.loss = Loss(mode, now_ms)
        told.said.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s")

    def _without_link(self, told: Told, body: Any) -> None:
        """Process what is flown without the link before any failure: the known way, then a circle, in ICAROUS's hand,
        and nothing where vehicles sense or merge; or the mission's own procedure, which has a row of its own.
        """
        now_ms, mode = body.Time, int(body.Mode)
        if self._asked is not None:
            told.loss = Loss(mode, now_ms)
            told.said.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s, without the link")
            return
        may = {
            loss_step(told.loss, FINISH, heard_ms, now_ms, self._silent_ms, way, end).loss.mode
            for way, end in product(EITHER, EITHER)
            # whether the vehicle was out of ICAROUS's hand meanwhile, which counts as heard, is seen by its gate
            for heard_ms in ((body.Heard,) if _flies(told) else (body.Heard, now_ms))
        }
        strange = mode not in may or mode == told.loss.mode or int(body.Chosen) != FINISH
        if self._merges_or_senses or strange:
            told.wrong.append((now_ms, f"{body.Mode.name} is not what follows then"))
        elif not _flies(told) and mode != LINKED:
            told.wrong.append((now_ms, f"{body.Mode.name} is flown, and UxAS has it"))
        told.loss = Loss(mode, now_ms)
        told.said.append(f"{body.Mode.name} from {now_ms / 1000:.2f} s, without the link")

    def status(self, body: Any) -> None:
        """A BridgeStatus says nothing of failures."""

    def end(self, body: Any) -> None:
        """Process MissionEnd: what is declared must have been followed by a flight under ICAROUS."""
        super().end(body)
        for told in self._seen.values():
            if told.failure.kind == NONE:
                continue
            if told.loss == NO_LOSS:
                told.wrong.append((body.Time, "nothing was flown after the failure"))
            if not _flies(told):
                told.wrong.append((body.Time, "ICAROUS did not have it after the failure"))

    def _verdict(self, vehicle: int, told: Flown) -> Verdict:
        note, at_ms, outcome = ", ".join(told.said), None, Outcome.HOLDS
        if down := self._down.get(vehicle):
            note = f"{note}; {down.words()}" if note else down.words()
        note = note or "it declared no failure"
        if told.wrong:
            outcome, (at_ms, text) = Outcome.VIOLATED, told.wrong[0]
            note = f"{text}; {note}"
        elif not self._over:
            outcome, note = Outcome.UNKNOWN, f"{note}; the messages stop too early"
        elif unseen := self._unseen(vehicle, (0, self._end_ms)):
            outcome, note = Outcome.UNKNOWN, f"{note}; {unseen}"
        asked: list[Any] = [failure_step, heard_by, loss_step] if told.checks else []
        kernels = tuple(qualified(kernel) for kernel in [*asked, *([on_ground] if down else [])])
        return Verdict(
            "G4", failure_item(vehicle), outcome, Kind.OBSERVED, note,
            time_ms=at_ms, vehicles=(vehicle,), checks=told.checks, kernels=kernels,
        )  # fmt: skip


def _flies(told: Told) -> bool:
    """Whether ICAROUS has the vehicle, by its gate."""
    return gate_accepts(told.gate, ICAROUS, told.gate.epoch)
