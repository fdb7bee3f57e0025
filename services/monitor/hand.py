"""Fraction of the time under ICAROUS with a valid certificate, as the vehicles report it; not a verdict."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.services.assumptions.authority import has_it, reported
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Verdict
from cratous.spec.records import replace

FEW = 3
"""Number of surprises that are listed; there may be more."""
ABOUT = ("G1", "G2")


@dataclass
class Held:
    """One vehicle. since_ms: time up to which it is counted, None while UxAS commands; until_ms:
    expiry of its certificate [ms].
    """

    since_ms: int | None = None
    until_ms: int = 0


@dataclass
class HandWatch:
    """Totals over all vehicles. under_ms: time under ICAROUS [ms]; certain_ms: the part of it with
    a valid certificate [ms]; said: unexpected events and periods without a certificate, in words;
    changes: number of certificate changes in the messages.
    """

    under_ms: int = 0
    certain_ms: int = 0
    changes: int = 0
    said: list[str] = field(default_factory=list)
    _held: dict[int, Held] = field(default_factory=dict)

    @classmethod
    def of(cls, mission: Mission) -> HandWatch:
        """The initial state, before any message."""
        return cls(_held={vehicle.id: Held() for vehicle in mission.vehicles})

    def gate(self, body: Any, time_ms: int) -> None:
        """Process a `GateState`: the commander may have changed."""
        held = self._held.get(body.VehicleID)
        if held is None:
            return
        self._count(held, time_ms)
        theirs = has_it(reported(body))
        if theirs and held.since_ms is None:
            held.since_ms = time_ms
        held.since_ms = held.since_ms if theirs else None

    def hand(self, body: Any, time_ms: int) -> None:
        """Process a `HandState`: the certificate of a vehicle has changed."""
        held = self._held.get(body.VehicleID)
        if held is None:
            return
        self._count(held, time_ms)
        self.changes += 1
        kind = body.Change.name
        if kind in ("Offered", "Known", "Left"):
            held.until_ms = body.Expiry
        at = f"vehicle {body.VehicleID} at {time_ms / 1000:.2f} s"
        if kind == "Known" and not body.Permitted:
            self.said.append(f"surprised: {at}, intruder {body.IntruderID}: {body.Reason}")
        elif kind in ("Flown", "Expired", "Missing"):
            word = {"Flown": "flown on", "Expired": "expired", "Missing": "none"}[kind]
            self.said.append(f"{word}: {at}: {body.Reason}")

    def end(self, time_ms: int) -> None:
        """Process MissionEnd: the messages are complete."""
        for held in self._held.values():
            self._count(held, time_ms)

    def _count(self, held: Held, now_ms: int) -> None:
        if held.since_ms is None:
            return
        self.under_ms += max(0, now_ms - held.since_ms)
        self.certain_ms += max(0, min(now_ms, held.until_ms) - held.since_ms)
        held.since_ms = max(now_ms, held.since_ms)

    def beside(self, verdict: Verdict) -> Verdict:
        """A verdict on G1 or G2 with the certificate statistics added to its note."""
        if verdict.requirement not in ABOUT or not self.changes:
            return verdict
        share = f"{self.certain_ms / 1000:.1f} of {self.under_ms / 1000:.1f} s under ICAROUS"
        said = self.said[:FEW]
        more = [f"and {len(self.said) - FEW} more"] if self.said[FEW:] else []
        told = "; ".join([f"a certificate was in hand for {share}", *said, *more])
        return replace(verdict, note=f"{verdict.note}; {told}" if verdict.note else told)
