"""G4: exactly one commander at any time; every takeover ends in a handback or a declared failure.

The monitor replays each vehicle's actuator gate with the proved gate kernels. Every command in the
messages must have been accepted or dropped as `gate_accepts` says, and every state that the gate
reports must be what `gate_after`, `gate_takeover` or `gate_offer` makes of the previous state.

A takeover still open at the end of the mission is a violation. If the link to the vehicle was
reported down and still is (BridgeStatus), that is a declared failure; the messages do not show
whether it is the reason for the missing handback, so the verdict is unknown. A takeover also ends
when the vehicle comes to rest on a landing site of the mission, and where the mission says what is
flown then, with a failure that its ICAROUS declares (FailureState).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority import gate as gates
from cratous.core.kernel import qualified
from cratous.services.mission.landing import on_failure_of
from cratous.services.monitor.landing import Down
from cratous.services.monitor.required_rows import authority_item
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

NAMES = {gates.UXAS: "UxAS", gates.ICAROUS: "ICAROUS"}
ON_COMMAND = {qualified(gates.gate_accepts), qualified(gates.gate_after)}
ON_STATE = {qualified(gates.gate_after)}
ON_CHANGE = {qualified(gates.gate_takeover), qualified(gates.gate_offer)}
"""Kernels that decide about a command, about a gate state, and about a state change without a command."""


@dataclass
class Command:
    """Observed authority over one vehicle.

    due: what must be reported next; forged: dropped commands with epochs that were never issued;
    refused: modes that were impossible; down: since when and why the link is down as last reported,
    empty while it is up; failed: the failure that was declared, empty if none; landed: where the last takeover ended on the ground; unended: takeover
    left open at the end with the link down, empty if none; had: (time [ms], commander), from time 0
    on.
    """

    gate: gates.Gate = field(default_factory=lambda: gates.Gate(gates.UXAS, 0, False))
    due: str = ""
    changes: int = 0
    takeovers: int = 0
    open_ms: int | None = None
    longest_ms: int = 0
    commands: int = 0
    dropped: int = 0
    forged: int = 0
    refused: int = 0
    down: str = ""
    failed: str = ""
    unended: str = ""
    landed: str = ""
    had: list[tuple[int, str]] = field(default_factory=lambda: [(0, NAMES[gates.UXAS])])
    faults: list[tuple[int, str]] = field(default_factory=list)
    kernels: set[str] = field(default_factory=set)


class AuthorityWatch:
    """Watches the authority over every protected vehicle."""

    def __init__(self, mission: Mission) -> None:
        self.vehicles = {v.id: Command() for v in mission.vehicles if v.protected}
        self._may_fail = frozenset(mission.instances if on_failure_of(mission) else ())
        self._ended = False

    def message(self, short: str, body: Any, time_ms: int) -> None:
        """Process a gate state, a command, a dropped command, or a mode refused by UxAS."""
        seen = self.vehicles.get(body.VehicleID)
        if seen is None:
            return
        if short == "ModeRefused":
            seen.refused += 1
            return
        if short == "CommandDropped":
            seen.dropped += 1
            seen.forged += not gates.epoch_given(seen.gate, body.Epoch)
            seen.kernels.add(qualified(gates.epoch_given))
            if seen.due != "drop":
                seen.faults.append((time_ms, "a command was dropped that had authority"))
            seen.due = ""
            return
        if short == "GatedCommand":
            self._missing(seen, time_ms)
            self._command(seen, body)
        else:
            self._state(seen, body, time_ms)

    def status(self, body: Any) -> None:
        """Process a BridgeStatus: the link to a vehicle is reported up or down."""
        seen = self.vehicles.get(body.VehicleID)
        if seen is None or self._ended:
            return
        if body.Alive:
            seen.down = ""
        elif not seen.down:
            seen.down = f"down since {body.Time / 1000:.2f} s ({body.Note})"

    def declared(self, body: Any) -> None:
        """Process a FailureState: a declared failure, which ends a takeover."""
        seen = self.vehicles.get(body.VehicleID)
        if seen is not None and body.VehicleID in self._may_fail:
            seen.failed = f"ended by a declared failure at {body.Time / 1000:.2f} s"

    def _command(self, seen: Command, body: Any) -> None:
        sender = gates.ICAROUS if body.Sender.name == "ICAROUS" else gates.UXAS
        seen.commands += 1
        seen.kernels |= ON_COMMAND
        accepted = gates.gate_accepts(seen.gate, sender, body.Epoch)
        after = gates.gate_after(seen.gate, sender, body.Epoch)
        seen.due = "state" if after != seen.gate else "" if accepted else "drop"

    def _missing(self, seen: Command, time_ms: int) -> None:
        """Record a fault if the report that the last command requires has not come."""
        if seen.due == "drop":
            text = f"a command without authority in epoch {seen.gate.epoch} was not dropped"
            seen.faults.append((time_ms, text))
        elif seen.due == "state":
            seen.faults.append((time_ms, "a handback was accepted but the gate did not change"))
        seen.due = ""

    def _state(self, seen: Command, body: Any, time_ms: int) -> None:
        owner = gates.ICAROUS if body.Owner.name == "ICAROUS" else gates.UXAS
        now, before = gates.Gate(owner, body.Epoch, body.Offered), seen.gate
        seen.kernels |= ON_STATE
        handback = gates.gate_after(before, gates.UXAS, before.epoch)
        allowed: tuple[gates.Gate, ...] = (handback,)
        if seen.due != "state":
            self._missing(seen, time_ms)
            seen.kernels |= ON_CHANGE
            allowed = (gates.gate_takeover(before), gates.gate_offer(before))
        if now not in allowed:
            text = f"the gate went from {_said(before)} to {_said(now)}"
            seen.faults.append((time_ms, text))
        seen.due, seen.gate = "", now
        seen.changes += 1
        if before.owner != now.owner:
            seen.had.append((time_ms, NAMES[now.owner]))
        if before.owner == gates.UXAS and now.owner == gates.ICAROUS:
            seen.takeovers += 1
            seen.open_ms = time_ms
        elif now.owner == gates.UXAS and seen.open_ms is not None:
            seen.longest_ms = max(seen.longest_ms, time_ms - seen.open_ms)
            seen.open_ms = None

    def end(self, body: Any, down: Mapping[int, Down]) -> None:
        """Process the end of the mission: a takeover may be open only with the link reported down,
        or landed.

        down: vehicles on the ground.
        """
        self._ended = True
        for number, seen in self.vehicles.items():
            self._missing(seen, body.Time)
            place = down.get(number)
            if seen.open_ms is not None and place is not None and place.good:
                seen.landed = place.words()
            elif seen.open_ms is not None and seen.failed:
                seen.landed = seen.failed
            elif seen.open_ms is not None:
                text = f"the takeover of {seen.open_ms / 1000:.2f} s was never handed back"
                if seen.down:
                    seen.unended = f"{text}; the link was declared {seen.down}, to the end"
                else:
                    seen.faults.append((body.Time, text))

    def verdicts(self) -> list[Verdict]:
        """One verdict per protected vehicle."""
        found = []
        for vehicle, seen in sorted(self.vehicles.items()):
            outcome = Outcome.HOLDS if self._ended else Outcome.UNKNOWN
            note = "no takeover"
            if seen.takeovers:
                many = "takeover" if seen.takeovers == 1 else "takeovers"
                note = f"{seen.takeovers} {many}, each handed back"
                note += f" (longest {seen.longest_ms / 1000:.2f} s)"
            if seen.landed:
                back = f"{seen.takeovers - 1} handed back, the last one "
                note = f"{seen.takeovers} {many}, {back if seen.takeovers > 1 else ''}{seen.landed}"
            note += f"; {seen.commands} commands, {seen.dropped} of them stale and dropped"
            if seen.forged:
                note += f", {seen.forged} of these of an epoch that was never given"
            if seen.refused:
                note += f"; at least {seen.refused} modes refused that could not be true"
            time_ms = None
            if seen.faults:
                outcome, (time_ms, note) = Outcome.VIOLATED, seen.faults[0]
            elif not self._ended:
                note = "the messages stop before the mission ends"
            elif seen.unended:
                outcome, note = Outcome.UNKNOWN, seen.unended
                time_ms = seen.open_ms
            elif not seen.commands:
                outcome, note = Outcome.UNKNOWN, "no command was seen"
            found.append(
                Verdict(
                    "G4",
                    authority_item(vehicle),
                    outcome,
                    Kind.EXACT,
                    note,
                    time_ms=time_ms,
                    vehicles=(vehicle,),
                    checks=seen.changes + seen.commands,
                    method="gate_accepts, gate_after, gate_offer, gate_takeover",
                    kernels=tuple(sorted(seen.kernels)),
                )
            )
        return found


def _said(gate: gates.Gate) -> str:
    offered = ", offered" if gate.offered else ""
    return f"{NAMES.get(gate.owner, gate.owner)} in epoch {gate.epoch}{offered}"
