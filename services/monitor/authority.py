"""G4: exactly one commander at any time; every takeover ends in a handback or declared failure."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cratous.core.gate import ICAROUS, UXAS
from cratous.spec.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission import Mission


@dataclass
class Command:
    """What has been seen of the authority over one vehicle."""

    owner: int = UXAS
    epoch: int = 0
    changes: int = 0
    takeovers: int = 0
    open_ms: int | None = None
    longest_ms: int = 0
    commands: int = 0
    dropped: int = 0
    faults: list[tuple[int, str]] = field(default_factory=list)


class AuthorityWatch:
    """Authority over every protected vehicle."""

    def __init__(self, mission: Mission) -> None:
        self.vehicles = {v.id: Command() for v in mission.vehicles if v.protected}
        self._ended = False

    def message(self, short: str, body: Any, time_ms: int) -> None:
        """A change of authority, a command, or a dropped command."""
        seen = self.vehicles.get(body.VehicleID)
        if seen is None:
            return
        if short == "GatedCommand":
            seen.commands += 1
        elif short == "CommandDropped":
            seen.dropped += 1
        else:
            self._change(seen, body, time_ms)

    def _change(self, seen: Command, body: Any, time_ms: int) -> None:
        owner = ICAROUS if body.Owner.name == "ICAROUS" else UXAS
        seen.changes += 1
        if body.Epoch <= seen.epoch:
            seen.faults.append((time_ms, f"epoch {body.Epoch} follows epoch {seen.epoch}"))
        if owner == seen.owner:
            seen.faults.append((time_ms, f"authority went from {body.Owner.name} to itself"))
        if owner == ICAROUS:
            seen.takeovers += 1
            seen.open_ms = time_ms
        elif seen.open_ms is not None:
            seen.longest_ms = max(seen.longest_ms, time_ms - seen.open_ms)
            seen.open_ms = None
        seen.owner, seen.epoch = owner, body.Epoch

    def end(self, body: Any) -> None:
        """The mission ended: no takeover may be left open."""
        self._ended = True
        for seen in self.vehicles.values():
            if seen.open_ms is not None:
                text = f"the takeover of {seen.open_ms / 1000:.2f} s was never handed back"
                seen.faults.append((body.Time, text))

    def verdicts(self) -> list[Verdict]:
        """One verdict a protected vehicle."""
        found = []
        for vehicle, seen in sorted(self.vehicles.items()):
            outcome = Outcome.HOLDS if self._ended else Outcome.UNKNOWN
            note = f"{seen.takeovers} takeovers, each handed back"
            if seen.takeovers:
                note += f" (longest {seen.longest_ms / 1000:.2f} s)"
            note += f"; {seen.dropped} stale commands dropped"
            time_ms = None
            if seen.faults:
                outcome, (time_ms, note) = Outcome.VIOLATED, seen.faults[0]
            elif not self._ended:
                note = "the messages stop before the mission ends"
            found.append(
                Verdict(
                    "G4",
                    f"authority over vehicle {vehicle}",
                    outcome,
                    Kind.OBSERVED,
                    note,
                    time_ms=time_ms,
                    vehicles=(vehicle,),
                    checks=seen.changes + seen.commands,
                    method="gate_accepts, gate_after",
                )
            )
        return found
