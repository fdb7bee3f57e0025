"""Model of one vehicle: its gate, its ICAROUS instance and the UxAS end, and the reports that are due."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts, gate_after
from cratous.services.system_model.finding import Misfit
from cratous.services.system_model.hand import HandModel
from cratous.services.system_model.icarous_end import IcarousEnd
from cratous.services.system_model.uxas_end import UxasEnd

REPORTS = ("GateState", "AuthorityChange", "CommandDropped")
EXECUTIVE, LINK = "uxas/executive", "uxas/ics"
HAND = "HandState"
OF_THE_LINK = ("Heartbeat", "BridgeStatus", "ModeRefused")
NUMBERS = {"UxAS": UXAS, "ICAROUS": ICAROUS}
NAMES = {number: name for name, number in NUMBERS.items()}
Report = tuple[str, str, int, int]
"""Kind; owner, or sender of a dropped command; epoch; offered (0 or 1), or the gate's epoch for a
dropped command.
"""


class VehicleModel:
    """The state of all three and of the certificate in hand, as far as the log shows; due: reports
    that must come next, in order.
    """

    def __init__(self, vehicle_id: int, has_instance: bool, heartbeat_ms: int) -> None:
        self.vehicle_id = vehicle_id
        self.gate = Gate(UXAS, 0, False)
        self.uxas = UxasEnd()
        self.icarous = IcarousEnd() if has_instance else None
        self.due: list[Report] = []
        self.hand = HandModel(heartbeat_ms)

    def event(self, short: str, source: str, body: Any, now_ms: int) -> None:
        """Process an event of this vehicle; Misfit if it is no step from any possible state."""
        teller = LINK if short in OF_THE_LINK else f"vehicle/{self.vehicle_id}"
        if short in (*REPORTS, *OF_THE_LINK, HAND) and source != teller:
            raise Misfit(f"the sender of a {short}", teller, source)
        if short in REPORTS:
            self._report(short, body, now_ms)
            return
        self.nothing_due(f"{short} of {source}")
        icarous = self.icarous
        theirs = gate_accepts(self.gate, ICAROUS, self.gate.epoch)
        if short == HAND:
            self.hand.changes(body, theirs, now_ms)
            return
        if not theirs:
            self.hand.handed_back(f"{short} of {source}")
        if icarous is not None and icarous.due and source != f"icarous/{self.vehicle_id}":
            raise Misfit(
                "a heartbeat of ICAROUS", "its command, for it changed the authority", short
            )
        self.uxas.hears(self.gate)
        if short == "GatedCommand":
            self._command(source, body, now_ms)
        elif short == "Heartbeat":
            self._beat(body, now_ms)
        elif short == "BridgeStatus":
            self.uxas.notes(body.Note, body.Alive, self.gate, now_ms)
        elif short == "ModeRefused":
            self.uxas.refuses(self.gate, bool(NUMBERS[body.Owner.name]), body.Epoch)
        elif short == "TaskProgress" and source == LINK:
            self.uxas.lets_go(self.gate)

    def nothing_due(self, got: str) -> None:
        """Misfit if a report has to come first."""
        if self.due:
            raise Misfit("a report of the gate", _said(self.due[0]), got)

    def end_of_heartbeat(self, now_ms: int, stands_still: bool = False) -> None:
        """A heartbeat's instant is over: ICAROUS has commanded, or monitored without acting; UxAS
        has sent its own, and reported a silence that was too long. stands_still: the mission lets
        ICAROUS stop now.
        """
        icarous = self.icarous
        if icarous is None:
            return
        # a flight begins with the connection: without it the link would never be checked
        if not self.uxas.met:
            expected = "that ICAROUS is connected before the end of the first heartbeat"
            raise Misfit("the link", expected, "no note that it is")
        if icarous.due:
            raise Misfit(
                "a heartbeat of ICAROUS", "its command after a change of authority", "none"
            )
        if not icarous.has_beaten(now_ms) and not stands_still:
            icarous.is_silent(self.gate, now_ms)
        # command lines may still be in transit once it has flown; before, only heartbeats arrive
        if self.uxas.open and not icarous.flown and self.uxas.is_silent(now_ms):
            heard = f"nothing; the last heartbeat came at {self.uxas.heard_ms} ms"
            raise Misfit("the link", "a report of silence", heard)

    def _report(self, short: str, body: Any, now_ms: int) -> None:
        got = _report_of(short, body)
        if self.due:
            if got != self.due[0]:
                raise Misfit("a report of the gate", _said(self.due[0]), _said(got))
            self.due.pop(0)
            return
        if short != "GateState" or self.icarous is None:
            raise Misfit("a report of the gate", "none: nothing has led to it", _said(got))
        self.uxas.hears(self.gate)
        after = Gate(NUMBERS[body.Owner.name], body.Epoch, body.Offered)
        self.icarous.wishes(self.gate, after, now_ms)
        before, self.gate = self.gate, after
        self.hand.commands(now_ms)
        self.due += _changes(before, after)

    def _command(self, source: str, body: Any, now_ms: int) -> None:
        sender, before = NUMBERS[body.Sender.name], self.gate
        by_icarous = sender == ICAROUS
        own = f"icarous/{self.vehicle_id}"
        senders = (own,) if by_icarous else (EXECUTIVE, LINK)
        if source not in senders or (by_icarous and self.icarous is None):
            expected = " or ".join(senders) if not by_icarous or self.icarous else "no instance"
            raise Misfit(f"a command in the name of {body.Sender.name}", expected, source)
        if self.icarous is not None and by_icarous:
            self.icarous.commands(before, now_ms)
            if not gate_accepts(before, ICAROUS, body.Epoch):
                expected = f"epoch {before.epoch}, the present one"
                raise Misfit("a command of ICAROUS", expected, f"epoch {body.Epoch}")
            self.hand.commands(now_ms)
        elif source == LINK:
            self.uxas.takes_back(before, body.Epoch)
        else:
            self.uxas.tells(body.Epoch)
        accepted = gate_accepts(before, sender, body.Epoch)
        self.gate = after = gate_after(before, sender, body.Epoch)
        if not accepted:
            self.due.append(("CommandDropped", body.Sender.name, body.Epoch, before.epoch))
        if after != before:  # a handback
            self.hand.leaves(now_ms)
            self.due.append(("GateState", NAMES[after.owner], after.epoch, int(after.offered)))
        self.due += _changes(before, after)

    def _beat(self, body: Any, now_ms: int) -> None:
        if self.icarous is None:
            raise Misfit("a heartbeat", "none, for the vehicle has no ICAROUS", body.Direction.name)
        if body.Direction.name == "Down":
            self.uxas.sends_beat(body.Sequence)
            return
        # its first heartbeat at this instant shows that the instance has run
        known = self.icarous.beats
        if not self.icarous.has_beaten(now_ms) and body.Sequence == known + 1:
            self.icarous.is_silent(self.gate, now_ms)
        if body.Sequence not in range(1, self.icarous.beats + 1):
            expected = f"a number that was sent: 1 to {self.icarous.beats}"
            raise Misfit("a heartbeat from ICAROUS", expected, f"number {body.Sequence}")
        self.uxas.hears_beat(now_ms)


def _changes(before: Gate, after: Gate) -> list[Report]:
    """The report of a change of owner, if it is one."""
    was, now = NAMES[before.owner], NAMES[after.owner]
    return [("AuthorityChange", now, after.epoch, 0)] if was != now else []


def _report_of(short: str, body: Any) -> Report:
    if short == "CommandDropped":
        return (short, body.Sender.name, body.Epoch, body.GateEpoch)
    offered = int(body.Offered) if short == "GateState" else 0
    return (short, body.Owner.name, body.Epoch, offered)


def _said(report: Report) -> str:
    short, who, epoch, last = report
    if short == "CommandDropped":
        return f"CommandDropped ({who}, epoch {epoch}, gate in epoch {last})"
    return f"{short} ({who}, epoch {epoch}{', offered' if last else ''})"
