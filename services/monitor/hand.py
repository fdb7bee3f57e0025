"""For how much of the time under ICAROUS a certificate was in hand, by what the vehicles say of it: no verdict."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.services.assumptions.authority import has_it, reported
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Verdict
from cratous.spec.records import replace

FEW = 3
"""So many surprises are named; there may be more."""
ABOUT = ("G1", "G2")


@dataclass
class Held:
    """One vehicle: since_ms: up to when it is counted, None while UxAS has it; until_ms: when what is in hand expires
    [ms]."""

    since_ms: int | None = None
    until_ms: int = 0


@dataclass
class HandWatch:
    """under_ms: time under ICAROUS of all vehicles; certain_ms: of it with a certificate [ms]; said: what was not
    allowed for, and where ICAROUS was silent, in words; changes: of a hand, that the messages tell."""

    under_ms: int = 0
    certain_ms: int = 0
    changes: int = 0
    said: list[str] = field(default_factory=list)
    _held: dict[int, Held] = field(default_factory=dict)

    @classmethod
    def of(cls, mission: Mission) -> HandWatch:
        """Before anything has come."""
        return cls(_held={vehicle.id: Held() for vehicle in mission.vehicles})

    def gate(self, body: Any, time_ms: int) -> None:
        """A change of a gate, as a `GateState`."""
        held = self._held.get(body.VehicleID)
        if held is None:
            return
        self._count(held, time_ms)
        theirs = has_it(reported(body))
        if theirs and held.since_ms is None:
            held.since_ms = time_ms
        held.since_ms = held.since_ms if theirs else None

    def hand(self, body: Any, time_ms: int) -> None:
        """A change of what is in hand, as a `HandState`."""
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
        """A verdict on G1 or G2, with what there is to say beside it."""
        if verdict.requirement not in ABOUT or not self.changes:
            return verdict
        share = f"{self.certain_ms / 1000:.1f} of {self.under_ms / 1000:.1f} s under ICAROUS"
        said = self.said[:FEW]
        more = [f"and {len(self.said) - FEW} more"] if self.said[FEW:] else []
        told = "; ".join([f"a certificate was in hand for {share}", *said, *more])
        return replace(verdict, note=f"{verdict.note}; {told}" if verdict.note else told)
