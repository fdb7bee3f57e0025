"""Assumptions on link and clocks: periods, delivery, and times that never decrease. Decided by `in_time`."""

from __future__ import annotations

from cratous.core.authority.gate import ICAROUS, Gate, epoch_given
from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.authority import UNTOUCHED, reported, sender_of
from cratous.services.assumptions.observations import ANY_LATER, EVERY, Message, Record
from cratous.spec.mission import Mission

OWN_TIME = ("Heartbeat", "GateState", "TruthState", "CommandDropped", "BridgeStatus")
"""Messages whose own time is their sending time; others contain earlier times too."""
PERIODS = 2
"""Heartbeats after which a line that has not come is late, as in G5."""
NO_INSTANCE = "no vehicle has an ICAROUS instance"


def _s(time_ms: int) -> str:
    return f"{time_ms / 1000:.2f} s"


class ClockWatch:
    """Checks that message times never decrease, neither the log's nor each sender's own."""

    kinds = EVERY

    def __init__(self) -> None:
        self._last_ms = 0
        self._asked_ms: int | None = None
        self._record = Record("s back", 0, (in_time,), waits="no message was seen")

    def message(self, message: Message) -> None:
        """Process any message; those with a time of their own are counted."""
        own, now_ms = message.kind in OWN_TIME, message.time_ms
        asked = self._asked_ms is not None and in_time(self._asked_ms, now_ms, 0)
        if asked and (not own or in_time(now_ms, message.body.Time, 0)):
            if own:  # compared with itself at this instant: both checks hold
                self._record.see_again(0.0, 2)
            return
        all_ok = True
        for time_ms in (now_ms, message.body.Time) if own else (now_ms,):
            ok = in_time(self._last_ms, time_ms, ANY_LATER)
            if own or not ok:
                self._record.see(max(0, self._last_ms - time_ms) / 1000)
            if not ok:
                text = f"a {message.kind} of {_s(time_ms)} after a message of {_s(self._last_ms)}"
                self._record.check(ok, self._last_ms, 0, text)
            all_ok = all_ok and ok
        self._asked_ms = now_ms if all_ok and in_time(self._last_ms, now_ms, 0) else None
        self._last_ms = now_ms

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"clock": self._record}


class PeriodWatch:
    """Checks that heartbeats from UxAS to each ICAROUS come at most one period apart."""

    kinds = ("Heartbeat", "TruthState")

    def __init__(self, mission: Mission) -> None:
        self._period_ms = mission.simulation.heartbeat_ms
        self._last = dict.fromkeys(mission.instances, 0)
        self._looked: tuple[int, ...] = ()
        none = "" if self._last else NO_INSTANCE
        self._record = Record(
            "s", self._period_ms / 1000, (in_time,), none, waits="no heartbeat was seen"
        )

    def message(self, message: Message) -> None:
        """Advance the time: every heartbeat and every position sample does."""
        kind, now_ms, _, body = message
        if kind not in ("Heartbeat", "TruthState"):
            return
        if now_ms not in self._looked:  # at the same instant the answer cannot change
            self._looked = (now_ms,)
            self._look(now_ms)
        down = kind == "Heartbeat" and body.Direction.name == "Down"
        if down and body.VehicleID in self._last:
            self._last[body.VehicleID] = now_ms

    def _look(self, now_ms: int) -> None:
        for number, last_ms in self._last.items():
            gap_ms = max(0, now_ms - last_ms)
            self._record.see(gap_ms / 1000)
            ok = in_time(0, gap_ms, self._period_ms)
            if not ok:
                text = f"no heartbeat to the ICAROUS of {number} from {_s(last_ms)} to {_s(now_ms)}"
                self._record.check(ok, last_ms + self._period_ms, number, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: the time since the last heartbeat counts too."""
        self._look(at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"heartbeat period": self._record}


class DeliveryWatch:
    """Checks that ICAROUS heartbeats arrive within two periods: the k-th is sent k - 1 periods after the start."""

    kinds = ("Heartbeat", "TruthState")

    def __init__(self, mission: Mission) -> None:
        self._period_ms = mission.simulation.heartbeat_ms
        self._bound_ms = PERIODS * self._period_ms
        self._next = dict.fromkeys(mission.instances, 1)
        self._came: dict[int, set[int]] = {number: set() for number in mission.instances}
        self._looked: tuple[int, ...] = ()
        self._late = False
        """Whether one was late when all were last checked."""
        none = "" if self._next else NO_INSTANCE
        self._record = Record("s", self._bound_ms / 1000, (in_time,), none)
        self._record.waits = "no heartbeat was seen"

    def _sent_ms(self, number: int) -> int:
        return (number - 1) * self._period_ms

    def message(self, message: Message) -> None:
        """Advance the time: every heartbeat and every position sample does."""
        kind, now_ms, _, body = message
        if kind not in ("Heartbeat", "TruthState"):
            return
        if kind == "Heartbeat" and body.VehicleID in self._next and body.Direction.name == "Up":
            self._come(body.VehicleID, body.Sequence, now_ms)
            if now_ms in self._looked and not self._late:
                # nothing has changed for the others
                self._late = self._is_late(body.VehicleID, self._next[body.VehicleID], now_ms)
                return
            self._looked = ()
        if now_ms not in self._looked:
            self._looked = (now_ms,)
            self._look(now_ms)

    def _come(self, vehicle: int, number: int, now_ms: int) -> None:
        sent_ms, came = self._sent_ms(number), self._came[vehicle]
        # a duplicate, or one never sent, says nothing about delivery
        fresh = in_time(self._sent_ms(self._next[vehicle]), sent_ms, ANY_LATER)
        if number in came or not fresh or not in_time(sent_ms, now_ms, ANY_LATER):
            return
        came.add(number)
        self._record.see((now_ms - sent_ms) / 1000)
        ok = in_time(sent_ms, now_ms, self._bound_ms)
        text = f"heartbeat {number} of {_s(sent_ms)} came at {_s(now_ms)}"
        self._record.check(ok, sent_ms + self._bound_ms, vehicle, text)
        while self._next[vehicle] in came:
            came.discard(self._next[vehicle])
            self._next[vehicle] += 1

    def _look(self, now_ms: int) -> None:
        self._late = False
        for vehicle, number in self._next.items():
            self._late |= self._is_late(vehicle, number, now_ms)

    def _is_late(self, vehicle: int, number: int, now_ms: int) -> bool:
        """Whether the first heartbeat that has not arrived is late."""
        sent_ms = self._sent_ms(number)
        if in_time(sent_ms, max(sent_ms, now_ms), self._bound_ms):
            return False
        self._record.see((now_ms - sent_ms) / 1000)
        text = f"heartbeat {number} of {_s(sent_ms)} had not come by {_s(now_ms)}"
        self._record.check(False, sent_ms + self._bound_ms, vehicle, text)
        return True

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: heartbeats late and not arrived count as not delivered."""
        self._look(at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"delivery from ICAROUS": self._record}


class ChangeWatch:
    """Checks that authority changes are communicated: an offer stays open no longer than line and
    command take, and UxAS sends no command in an epoch that ended longer ago than a line takes.
    """

    kinds = ("Heartbeat", "TruthState", "GateState", "GatedCommand")

    def __init__(self, mission: Mission) -> None:
        self._line_ms = PERIODS * mission.simulation.heartbeat_ms
        self._gates = dict.fromkeys(mission.instances, UNTOUCHED)
        self._since = dict.fromkeys(mission.instances, 0)
        self._offers: list[int] = []
        none = "" if self._gates else NO_INSTANCE
        taken_s, told_s = 2 * self._line_ms / 1000, self._line_ms / 1000
        self._taken = Record("s", taken_s, (in_time,), none, waits="no offer was made")
        waits = "UxAS sent no command in an epoch that was over"
        self._told = Record("s", told_s, (in_time, epoch_given), none, waits=waits)

    def message(self, message: Message) -> None:
        """Process a gate state or a command; heartbeats and samples advance the time."""
        kind, now_ms, _, body = message
        if kind in ("Heartbeat", "TruthState"):
            self._look(now_ms)
        elif kind == "GateState" and body.VehicleID in self._gates:
            self._look(now_ms)
            gate, before = reported(body), self._gates[body.VehicleID]
            if not epoch_given(before, gate.epoch):
                self._since[body.VehicleID] = now_ms
            self._gates[body.VehicleID] = gate
            self._offers = [number for number, one in self._gates.items() if one.offered]
        elif kind == "GatedCommand" and body.VehicleID in self._gates:
            self._command(message)

    def _command(self, message: Message) -> None:
        """Check a UxAS command in an old epoch: it has not been told of the change."""
        body, now_ms = message.body, message.time_ms
        number, gate = body.VehicleID, self._gates[body.VehicleID]
        past = epoch_given(Gate(gate.owner, gate.epoch - 1, False), body.Epoch)
        if sender_of(body) == ICAROUS or not past:
            return
        since_ms = self._since[number]
        over_ms = max(0, now_ms - since_ms)
        self._told.see(over_ms / 1000)
        ok = in_time(0, over_ms, self._line_ms)
        text = (
            f"a command of UxAS in epoch {body.Epoch}; epoch {gate.epoch} began at {_s(since_ms)}"
        )
        self._told.check(ok, since_ms + self._line_ms, number, text)

    def _look(self, now_ms: int) -> None:
        for number in self._offers:
            since_ms = self._since[number]
            open_ms = max(0, now_ms - since_ms)
            self._taken.see(open_ms / 1000)
            ok = in_time(0, open_ms, 2 * self._line_ms)
            text = f"the offer of {_s(since_ms)} had not been taken by {_s(now_ms)}"
            self._taken.check(ok, since_ms + 2 * self._line_ms, number, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: an open offer counts up to here."""
        self._look(at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"offers taken": self._taken, "takeovers told": self._told}
