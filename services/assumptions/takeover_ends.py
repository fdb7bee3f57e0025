"""Assumptions for takeovers to end: UxAS is heard on board, and the return path is clear. Decided
by `in_time` and the gate kernels.

An ICAROUS reports when it no longer hears UxAS (`UxasHeard`). It does not report that its return
path is clear, but offers control once it has been clear for long enough: if it hears UxAS and
offers nothing for longer than that, the path was not clear.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.authority.gate import gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.authority import has_it, reported
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.observations import Message, Record, gone_ms
from cratous.services.mission.landing import on_failure_of
from cratous.spec.mission import Mission
from cratous.spec.system.ending import MOST_PATIENCE

LEAST_MS = 1500
"""Time for which the return path has to be clear [ms]; a test compares it with the instance's value."""
LINKED = "Linked"
HEARD_MS = 2000
"""Time after a line for which ICAROUS counts UxAS as heard [ms]; a test compares it with the instance's value."""


def not_told(mission: Mission, told: bool) -> str:
    """Why it is unknown whether UxAS is heard; empty if it is known. told: each ICAROUS reports it."""
    if not mission.instances:
        return NO_INSTANCE
    return "" if told else "this ICAROUS does not say whether it hears UxAS"


def coarse(mission: Mission) -> str:
    """Why a silence may not have been reported, "" if each is: with a lost-link procedure only long ones are."""
    loss = mission.link_loss
    told = on_failure_of(mission) is not None  # beside it each silence is reported (`UxasHeard`)
    if loss is None or told or in_time(0, loss.after_ms, HEARD_MS):
        return ""
    return f"a silence of up to {loss.after_ms / 1000:g} s is not told (link_loss)"


class HeardWatch:
    """Checks that each ICAROUS hears UxAS at each of its heartbeats."""

    kinds = ("Heartbeat", "UxasHeard", "LinkLossState")

    def __init__(self, mission: Mission, told: bool = True) -> None:
        self._instances = frozenset(mission.instances)
        self._of_link = on_failure_of(mission) is None
        none = not_told(mission, told)
        waits = "no heartbeat of ICAROUS was seen"
        self._record = Record("s", HEARD_MS / 1000, (in_time,), none, waits=waits)

        self._record.gaps += [why for why in (coarse(mission),) if why and not none]

    def message(self, message: Message) -> None:
        """Process a heartbeat of an ICAROUS, or its report of whether it hears UxAS."""
        kind, _, source, body = message
        if kind not in self.kinds or body.VehicleID not in self._instances:
            return
        if kind == "Heartbeat":
            if body.Direction.name == "Up":
                self._record.see(None)
        elif source not in ("", f"icarous/{body.VehicleID}"):
            return
        elif kind == "UxasHeard":
            self._told(body.VehicleID, bool(body.Heard), body.Last, body.Time)
        elif self._of_link:  # after a declared failure UxAS may be heard, and is not obeyed
            self._told(body.VehicleID, body.Mode.name == LINKED, body.Heard, body.Time)

    def _told(self, number: int, heard: bool, last_ms: int, now_ms: int) -> None:
        self._record.see(None if heard else max(0, now_ms - last_ms) / 1000)
        since_s, until_s = last_ms / 1000, now_ms / 1000
        text = f"no line of UxAS reached the ICAROUS of {number} from {since_s:.2f} s to {until_s:.2f} s"
        self._record.check(heard, last_ms + HEARD_MS, number, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"delivery to ICAROUS": self._record}


class Away(NamedTuple):
    """State of one takeover. since_ms: start of the wait for a clear return path [ms]; offered:
    ICAROUS offers control.
    """

    since_ms: int
    offered: bool = False


class WayBackWatch:
    """Checks for each takeover whether control was offered, and if not by the end, for how long it was not."""

    kinds = ("GateState", "UxasHeard", "LinkLossState", "FailureState")

    def __init__(self, mission: Mission, told: bool = True) -> None:
        self._away: dict[int, Away] = {}
        self._instances = frozenset(mission.instances)
        self._unheard, self._failed = set[int](), set[int]()
        self._gone_ms, self._coarse = gone_ms(mission), coarse(mission)
        # the path is first checked one heartbeat after the takeover, and control is offered at a
        # heartbeat
        self._wait_ms = MOST_PATIENCE * LEAST_MS + 2 * mission.simulation.heartbeat_ms
        none = not_told(mission, told)
        self._record = Record(
            "s", self._wait_ms / 1000, (gate_accepts, in_time), none, waits="no takeover"
        )

    def message(self, message: Message) -> None:
        """Process a gate change, or a report of whether an ICAROUS hears UxAS."""
        kind, now_ms, _, body = message
        if kind not in self.kinds or body.VehicleID not in self._instances:
            return
        number = body.VehicleID
        if kind == "FailureState":
            self._failed.add(number)
            self._over(number)
        elif number in self._failed:
            return  # it offers nothing any more, whether the path is clear or not
        elif kind == "UxasHeard":
            self._hears(number, bool(body.Heard), now_ms)
        elif kind == "LinkLossState":
            self._hears(number, body.Mode.name == LINKED, now_ms)
        elif kind == "GateState":
            gate = reported(body)
            if not has_it(gate):
                self._over(number)
            elif number not in self._away or gate.offered != self._away[number].offered:
                self._away[number] = Away(now_ms, gate.offered)

    def _over(self, number: int) -> None:
        """End a takeover: UxAS commands the vehicle, so the return path was clear when control was offered."""
        if self._away.pop(number, None) is not None:
            self._record.see(None)

    def _hears(self, number: int, heard: bool, now_ms: int) -> None:
        if not heard:
            self._unheard.add(number)
            return
        self._unheard.discard(number)
        away = self._away.get(number)
        if away is not None and not away.offered:
            self._away[number] = away._replace(since_ms=now_ms)

    def end(self, at_ms: int) -> None:
        """A takeover still open without an offer counts as a blocked return path, if that can be determined."""
        for number, away in sorted(self._away.items()):
            until_ms = max(away.since_ms, min(at_ms, self._gone_ms.get(number, at_ms)))
            waited_ms = until_ms - away.since_ms
            self._record.see(None if away.offered else waited_ms / 1000)
            if away.offered:
                continue
            since_s, until_s = away.since_ms / 1000, until_ms / 1000
            if number in self._unheard:
                self._record.gaps.append(f"the ICAROUS of {number} did not hear UxAS at the end")
            elif self._coarse:
                self._record.gaps.append(self._coarse)
            elif in_time(away.since_ms, until_ms, self._wait_ms):
                self._record.gaps.append(
                    f"vehicle {number} was under ICAROUS from {since_s:.2f} s to {until_s:.2f} s, too short to tell"
                )
            else:
                text = f"ICAROUS had vehicle {number} from {since_s:.2f} s to {until_s:.2f} s, heard UxAS, and offered nothing"
                self._record.check(False, away.since_ms, number, text)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"way back free": self._record}
