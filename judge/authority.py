"""G4: exactly one of UxAS and ICAROUS commands each protected vehicle, and takeovers end.

Three sources must be consistent: the gate's states, the accepted or dropped commands, and the
reported changes of authority. A vehicle begins with UxAS in epoch 0. ICAROUS takes over, offers
control, or withdraws its offer, each in the next epoch. UxAS regains control with its first command
of the offer's epoch; this begins no epoch. A command is valid if its epoch is the current one and
its sender has control, or is UxAS under an offer; any other must be dropped.

Without a link no handback is possible. A takeover open at the end is a violation; if the link had
been declared down (BridgeStatus) and not declared alive again, it is unknown whether it would have
ended. A takeover also ends when the vehicle has come to rest on a landing site, and, in a mission
that says what is flown then, with a declared failure (`FailureState`) of the vehicle.
"""

from __future__ import annotations

from collections.abc import Iterator

from cratous.judge.ground import down, stands_at_start
from cratous.judge.log import Bridge, Gate, Log
from cratous.judge.mission import Mission
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

UXAS, ICAROUS = "UxAS", "ICAROUS"


class _Story:
    """The history of one vehicle so far. due: the report that must come next."""

    def __init__(self) -> None:
        self.owner, self.epoch, self.offered = UXAS, 0, False
        self.due = ""
        self.said_owner = UXAS
        self.commands = self.takeovers = self.handbacks = self.dropped = 0
        self.open_ms: int | None = None
        self.faults: list[tuple[int, str]] = []

    def fault(self, at_ms: int, text: str) -> None:
        self.faults.append((at_ms, text))

    def settle(self, at_ms: int) -> None:
        """Record a fault if a report is still due."""
        if self.due == "drop":
            self.fault(at_ms, "a command came through from one who did not have control")
        elif self.due == "handback":
            self.fault(at_ms, "UxAS took the offer, and the gate did not change")
        self.due = ""

    def command(self, said: Gate) -> None:
        self.settle(said.time_ms)
        self.commands += 1
        acts = said.epoch == self.epoch and (
            said.side == self.owner or (said.side == UXAS and self.offered)
        )
        if not acts:
            self.due = "drop"
        elif said.side != self.owner:
            self.due = "handback"

    def drop(self, said: Gate) -> None:
        self.dropped += 1
        if self.due != "drop":
            self.fault(said.time_ms, f"a command of {said.side} was dropped that had control")
            self.settle(said.time_ms)
        self.due = ""

    def state(self, said: Gate) -> None:
        now = (said.side, said.epoch, said.offered)
        taking_back = self.due == "handback"
        if not taking_back:
            self.settle(said.time_ms)
        allowed = {(UXAS, self.epoch, False)} if taking_back else {(ICAROUS, self.epoch + 1, False)}
        if not taking_back and self.owner == ICAROUS and not self.offered:
            allowed.add((ICAROUS, self.epoch + 1, True))
        if now not in allowed:
            before = _words(self.owner, self.epoch, self.offered)
            self.fault(said.time_ms, f"the gate went from {before} to {_words(*now)}")
        self._announced(said.time_ms)
        self.due = ""
        if self.owner == UXAS and said.side == ICAROUS:
            self.takeovers += 1
            self.open_ms = said.time_ms
        elif self.owner == ICAROUS and said.side == UXAS:
            self.handbacks += 1
            self.open_ms = None
        self.owner, self.epoch, self.offered = now

    def change(self, said: Gate) -> None:
        if (said.side, said.epoch) != (self.owner, self.epoch):
            text = f"{said.side} is announced in epoch {said.epoch}, the gate has "
            self.fault(said.time_ms, text + _words(self.owner, self.epoch, self.offered))
        elif said.side == self.said_owner:
            self.fault(said.time_ms, f"{said.side} is announced twice")
        self.said_owner = said.side

    def _announced(self, at_ms: int) -> None:
        if self.said_owner != self.owner:
            self.fault(at_ms, f"that {self.owner} has control was not announced")
            self.said_owner = self.owner

    def end(self, at_ms: int, down_ms: int | None, landed: bool) -> str:
        """Process the mission's end: control must have been handed back. A failed task ends no
        takeover.

        down_ms: time since which the link is declared down, None if it is not. Returns what is
        unknown for that reason. landed: it is at rest on a landing site, or on the ground where it
        started.
        """
        self.settle(at_ms)
        self._announced(at_ms)
        if self.open_ms is None or landed:
            return ""
        said = f"the takeover of {seconds(self.open_ms)} was never handed back"
        if down_ms is None:
            self.fault(self.open_ms, said)
            return ""
        return f"{said}; the link was declared down at {seconds(down_ms)}, to the end"


def _down_ms(statuses: list[Bridge], end_ms: int) -> int | None:
    """Time since which a link is declared down at the end; None if it is not."""
    since = None
    for status in statuses:
        if status.time_ms > end_ms:
            break
        if status.alive:
            since = None
        elif since is None:
            since = status.time_ms
    return since


def _words(owner: str, epoch: int, offered: bool) -> str:
    return f"{owner} in epoch {epoch}{', offered' if offered else ''}"


def rows(mission: Mission, log: Log, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each protected vehicle."""
    for vehicle in mission.protected:
        story = _Story()
        for said in log.gates:
            if said.vehicle == vehicle:
                getattr(story, said.kind)(said)
        subject, item = ("authority", str(vehicle)), f"authority over vehicle {vehicle}"
        doubt, place = "", down(mission, vehicle, flown.get(vehicle))
        if log.end_ms is not None:
            silent_ms = _down_ms(log.bridges.get(vehicle, []), log.end_ms)
            rests = stands_at_start(mission, vehicle, flown.get(vehicle))
            rests = rests or (place is not None and place.good)
            rests = rests or (mission.after_failure is not None and vehicle in log.declared)
            doubt = story.end(log.end_ms, silent_ms, rests)
        note = (
            f"{story.takeovers} takeovers, {story.handbacks} handbacks, {story.commands} commands, "
            f"{story.dropped} of them dropped"
        )
        note += f"; it {place.words()}" if place is not None else ""
        if story.faults:
            at_ms, text = min(story.faults, key=lambda fault: fault[0])
            note = f"{text} (at {seconds(at_ms)}; {len(story.faults)} faults); {note}"
            yield Row("G4", subject, item, VIOLATED, note, at_ms, story.commands)
        elif not story.commands:
            yield Row("G4", subject, item, UNKNOWN, "no command to it was logged")
        elif log.end_ms is None:
            yield Row(
                "G4", subject, item, UNKNOWN, f"the log stops before the mission ends; {note}"
            )
        elif doubt:
            note = f"{doubt}; {note}"
            yield Row("G4", subject, item, UNKNOWN, note, story.open_ms, story.commands)
        else:
            yield Row("G4", subject, item, HOLDS, note, None, story.commands)
