"""Assumptions on who sends commands and reports, and in which epoch. Decided by the kernels of the gate."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.gate import ICAROUS, UXAS, Gate, epoch_given, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.observations import Message, Record
from cratous.spec.mission import Mission

UNTOUCHED = Gate(UXAS, 0, False)
"""The initial gate: UxAS commands, and always has."""
COMMANDS = ("MissionCommand", "VehicleActionCommand", "FollowPathCommand")
"""Commands that an autopilot follows without a gate."""
NUMBERS = {"UxAS": UXAS, "ICAROUS": ICAROUS}
EXECUTIVE, LINK = "uxas/executive", "uxas/ics"


def icarous_has(body: Any) -> bool:
    """Whether an `AuthorityChange` gives the vehicle to ICAROUS."""
    return has_it(Gate(NUMBERS.get(body.Owner.name, UXAS), body.Epoch, False))


def reported(body: Any) -> Gate:
    """The gate that a `GateState` reports."""
    return Gate(NUMBERS.get(body.Owner.name, UXAS), body.Epoch, body.Offered)


def sender_of(body: Any) -> int:
    """The sender that a `GatedCommand` names."""
    return NUMBERS.get(body.Sender.name, UXAS)


def has_it(gate: Gate) -> bool:
    """Whether ICAROUS may command the vehicle."""
    return gate_accepts(gate, ICAROUS, gate.epoch)


class CommandWatch:
    """Checks commands and reports of every protected vehicle."""

    kinds = (*COMMANDS, "GatedCommand", "GateState", "TaskProgress")

    def __init__(self, mission: Mission) -> None:
        protected = [v.id for v in mission.vehicles if v.protected]
        self._gates = dict.fromkeys(protected, UNTOUCHED)
        self._all = frozenset(v.id for v in mission.vehicles)
        self._first = set(protected)
        self._suspended: set[int] = set()
        none = "" if protected else "no vehicle is protected"
        waits = "no command was seen"
        self._begun = Record(kernels=(gate_accepts,), unseen=none, waits=waits)
        self._reports = Record("reports of others", 0, unseen=none, waits="no gate has changed")
        self._told = Record("commands", 0, (epoch_given,), none, waits=waits)
        self._kept = Record("epochs back", 0, (epoch_given,), none, waits="no gate has changed")
        self._alone = Record("commands", 0, unseen=none, waits=waits)
        self._silent = Record("commands", 0, unseen=none, waits="no task was suspended")
        self._counts = dict.fromkeys(("reports", "told", "alone", "suspended"), 0)

    def message(self, message: Message) -> None:
        """Process a command, a gate report, or the suspension of a task."""
        kind, _, _, body = message
        if kind in COMMANDS:
            self._bare(message)
            return
        if kind not in ("GatedCommand", "GateState", "TaskProgress"):
            return
        if body.VehicleID not in self._gates:
            return
        if kind == "GatedCommand":
            self._command(message)
        elif kind == "GateState":
            self._report(message)
        elif body.Phase.name == "Suspended" and message.source == LINK:
            self._suspended.add(body.VehicleID)

    def _bare(self, message: Message) -> None:
        number = message.body.VehicleID
        if number not in self._all:
            return
        self._counts["alone"] += 1
        self._alone.see(self._counts["alone"])
        text = f"{message.kind} to vehicle {number} outside of its gate"
        self._alone.check(False, message.time_ms, number, text)

    def _command(self, message: Message) -> None:
        body, now_ms = message.body, message.time_ms
        number, gate = body.VehicleID, self._gates[body.VehicleID]
        self._alone.see(self._counts["alone"])
        if number in self._first:
            self._first.discard(number)
            self._begun.see(None)
            first = gate_accepts(UNTOUCHED, sender_of(body), body.Epoch)
            text = f"the first command is one of {body.Sender.name} in epoch {body.Epoch}"
            self._begun.check(first, now_ms, number, text)
        given = epoch_given(gate, body.Epoch)
        self._counts["told"] += not given
        self._told.see(self._counts["told"])
        text = f"a command of {body.Sender.name} in epoch {body.Epoch}; the gate is in {gate.epoch}"
        self._told.check(given, now_ms, number, text)
        self._while_suspended(message, number)

    def _while_suspended(self, message: Message, number: int) -> None:
        """A suspension ends with the command that takes the vehicle back; before it the executive
        sends no command.
        """
        if number not in self._suspended or sender_of(message.body) == ICAROUS:
            return
        if message.source == LINK:
            self._suspended.discard(number)
            self._silent.see(self._counts["suspended"])
        elif message.source == EXECUTIVE:
            self._counts["suspended"] += 1
            self._silent.see(self._counts["suspended"])
            text = "a command of the executive while its flying of the vehicle was suspended"
            self._silent.check(False, message.time_ms, number, text)

    def _report(self, message: Message) -> None:
        body, now_ms = message.body, message.time_ms
        number, gate = body.VehicleID, reported(body)
        if not message.source:
            self._reports.unseen = "the messages do not name their senders"
        own = message.source == f"vehicle/{number}"
        self._counts["reports"] += bool(message.source) and not own
        self._reports.see(self._counts["reports"])
        text = f"a report of the gate of vehicle {number} by {message.source}"
        self._reports.check(own or not message.source, now_ms, number, text)
        before = self._gates[number]
        self._kept.see(max(0, before.epoch - gate.epoch))
        text = f"the gate went from epoch {before.epoch} to {gate.epoch}"
        self._kept.check(epoch_given(gate, before.epoch), now_ms, number, text)
        self._gates[number] = gate

    def end(self, at_ms: int) -> None:
        """Report vehicles without any command as not observed."""
        if self._first and self._begun.checks:
            names = ", ".join(map(str, sorted(self._first)))
            self._begun.gaps.append(f"no command to vehicle {names} was seen")

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {
            "first command": self._begun,
            "reports of the gate": self._reports,
            "epochs told": self._told,
            "epochs kept": self._kept,
            "commands by the gate alone": self._alone,
            "suspended": self._silent,
        }


class SteeringWatch:
    """Checks that ICAROUS commands a vehicle under its control at each heartbeat, having read the gate."""

    kinds = ("GateState", "GatedCommand", "Heartbeat")

    def __init__(self, mission: Mission) -> None:
        self._period_ms = mission.simulation.heartbeat_ms
        self._instances = frozenset(mission.instances)
        self._last: dict[int, int] = {}
        none = "" if mission.instances else "no vehicle has an ICAROUS instance"
        self._record = Record("s", self._period_ms / 1000, (in_time,), none, waits="no takeover")

    def message(self, message: Message) -> None:
        """Process a gate change or a command of ICAROUS; every message advances the time."""
        kind, now_ms, _, body = message
        if kind == "GateState" and body.VehicleID in self._instances:
            self._look(now_ms)
            if has_it(reported(body)):
                self._last.setdefault(body.VehicleID, now_ms)
            else:
                self._last.pop(body.VehicleID, None)
        elif kind == "GatedCommand" and sender_of(body) == ICAROUS:
            self._look(now_ms)
            if body.VehicleID in self._last:
                self._last[body.VehicleID] = now_ms
        elif kind == "Heartbeat":
            self._look(now_ms)

    def _look(self, now_ms: int) -> None:
        for number, last_ms in self._last.items():
            gap_ms = max(0, now_ms - last_ms)
            self._record.see(gap_ms / 1000)
            ok = in_time(0, gap_ms, self._period_ms)
            text = f"no command of ICAROUS between {last_ms / 1000:.2f} s and {now_ms / 1000:.2f} s"
            self._record.check(ok, last_ms + self._period_ms, number, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: an open takeover counts up to here."""
        self._look(at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"ICAROUS at each heartbeat": self._record}
