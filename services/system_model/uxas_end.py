"""Model of the UxAS end of one vehicle's link: the set of all states consistent with the log.

SETMOD lines are not in the log: any line may have arrived at any time, late, duplicated or forged.
The flown kernel decides the end's reaction; where it acts on a line (releases or takes back a
vehicle), the log shows it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from cratous.core.authority.gate import UXAS, Gate, gate_accepts
from cratous.core.authority.link_end import (
    LinkEnd,
    link_mode,
    link_sign,
    suspended_after,
    track_is_told,
)
from cratous.services.flight.link_end import LINK_LOST_MS
from cratous.services.flight.link_peers import START
from cratous.services.system_model.finding import Misfit
from cratous.spec.authority import link_end as ends

CONNECTED = ("connected", "connected again")
SILENT = re.compile(r"silent since (\d{1,15}) ms")
OVERTAKEN = re.compile(r"a mode of epoch (-?\d{1,18}) is overtaken by one of epoch (\d{1,18})")
EITHER = (False, True)


class Believes(NamedTuple):
    """The end's state, and whether UxAS's own flight of the vehicle is suspended."""

    end: LinkEnd
    suspended: bool


class UxasEnd:
    """possible: possible states; taken: epoch in which UxAS last took the vehicle; met: it has been
    connected; open: the connection is up; downs: number of heartbeats sent; heard_ms: time of the
    last heartbeat received [ms].
    """

    def __init__(self) -> None:
        self.possible: frozenset[Believes] = frozenset({Believes(START, False)})
        self.taken = 0
        self.met = False
        self.open = False
        self.downs = 0
        self.heard_ms = 0

    def hears(self, gate: Gate) -> None:
        """Unlogged lines may have arrived: those that have no effect, or that release the vehicle."""
        for act in (ends.NOTHING, ends.SUSPEND):
            self.possible |= self._after(gate, EITHER, gate.epoch, act)

    def lets_go(self, gate: Gate) -> None:
        """A task's path was left, by the log: a line has released the vehicle."""
        after = self._after(gate, (True,), gate.epoch, ends.SUSPEND)
        expected = "a takeover that UxAS can believe, and has not yet"
        self._keep(after, "UxAS lets the vehicle go", expected, f"the gate is {said(gate)}")

    def takes_back(self, gate: Gate, epoch: int) -> None:
        """A command takes the vehicle back: an offer of its epoch has arrived and was believed."""
        after = self._after(gate, (False,), epoch, ends.TAKE_BACK)
        got = f"epoch {epoch}, while the gate is {said(gate)}"
        self._keep(after, "a handback", "one that answers an open offer, in its epoch", got)
        self.taken = epoch

    def tells(self, epoch: int) -> None:
        """A command of the executive: UxAS flies the vehicle, and states the epoch in which it took it."""
        if not gate_accepts(Gate(UXAS, self.taken, False), UXAS, epoch):
            expected = f"epoch {self.taken}, in which UxAS has last taken the vehicle"
            raise Misfit("a command of UxAS", expected, f"epoch {epoch}")
        flies = frozenset(b for b in self.possible if track_is_told(b.suspended, True))
        expected = "none while UxAS's own flying of the vehicle is suspended"
        self._keep(flies, "a command of UxAS", expected, f"one of epoch {epoch}")

    def refuses(self, gate: Gate, active: bool, epoch: int) -> None:
        """A line with an impossible mode was refused."""
        after = self._after(gate, (active,), epoch, ends.REFUSED)
        mode = "ICAROUS commands" if active else "control is offered"
        got = f"one of epoch {epoch} ({mode}) refused, while the gate is {said(gate)}"
        self._keep(after, "a mode refused", "a mode that cannot be true", got)

    def connects(self, now_ms: int) -> None:
        """The connection is up, for the first time or again."""
        self.met, self.open, self.heard_ms = True, True, now_ms
        alive = (b._replace(end=b.end._replace(alive=True)) for b in self.possible)
        self.possible = frozenset(alive)

    def notes(self, note: str, alive: bool, gate: Gate, now_ms: int) -> None:
        """Process a link note: liveness, or an outdated mode; other notes change nothing.

        alive: whether the note reports that ICAROUS is heard.
        """
        if note in CONNECTED:
            self.connects(now_ms)
        elif note == "heard again":
            self._signs(ends.HEARD, ends.SAY_HEARD, now_ms, now_ms)
            self.heard_ms = now_ms
        elif note.startswith("link lost"):
            self._signs(ends.ENDED, ends.SAY_LOST, now_ms, now_ms)
            self.open = False
        elif (silent := SILENT.fullmatch(note)) is not None:
            if not self.is_silent(now_ms):
                heard = f"a heartbeat came at {self.heard_ms} ms"
                raise Misfit("a report of silence", f"one after more than {LINK_LOST_MS} ms", heard)
            self._signs(ends.PASSED, ends.SAY_SILENT, int(silent[1]), now_ms)
        elif (past := OVERTAKEN.fullmatch(note)) is not None:
            after = self._after(gate, EITHER, int(past[1]), ends.OVERTAKEN)
            expected = f"an epoch before the present one, {gate.epoch}"
            self._keep(after, "a mode that is overtaken", expected, note)
        else:
            return
        agree = frozenset(b for b in self.possible if b.end.alive == alive)
        self._keep(agree, "a status of the link", f"alive {not alive}", f"alive {alive}: {note}")

    def sends_beat(self, sequence: int) -> None:
        """A heartbeat is sent to ICAROUS; Misfit unless the connection is up and the number is the next one."""
        if not self.open or sequence != self.downs + 1:
            number = f"number {self.downs + 1}" if self.open else "none without a connection"
            raise Misfit("a heartbeat to ICAROUS", number, f"number {sequence}")
        self.downs += 1

    def hears_beat(self, now_ms: int) -> None:
        """A heartbeat of ICAROUS has arrived; Misfit unless the connection is up and was reported alive."""
        if not self.open or not all(b.end.alive for b in self.possible):
            expected = "that the link is said to be heard before"
            raise Misfit("a heartbeat from ICAROUS", expected, "none said so")
        self.heard_ms = now_ms

    def is_silent(self, now_ms: int) -> bool:
        """True if ICAROUS's heartbeats have been missing for too long and that was not reported yet."""
        signs = (
            link_sign(b.end, ends.PASSED, self.heard_ms, now_ms, LINK_LOST_MS)
            for b in self.possible
        )
        return all(sign.act == ends.SAY_SILENT for sign in signs)

    def _signs(self, event: int, says: int, heard_ms: int, now_ms: int) -> None:
        after = set()
        for b in self.possible:
            sign = link_sign(b.end, event, heard_ms, now_ms, LINK_LOST_MS)
            if sign.act == says:
                after.add(b._replace(end=sign.end))
        expected = "none: nothing has changed, or the last message is not too old"
        got = ("", "heard again", "link lost", "silent")[says]
        self._keep(frozenset(after), "a sign of life, or none", expected, got)

    def _after(
        self, gate: Gate, modes: Iterable[bool], epoch: int, act: int
    ) -> frozenset[Believes]:
        """The states after a line of this epoch to which the end reacts in this way."""
        after = set()
        for b in self.possible:
            for active in modes:
                linked = link_mode(b.end, gate, active, epoch)
                if linked.act == act:
                    after.add(Believes(linked.end, suspended_after(b.suspended, act)))
        return frozenset(after)

    def _keep(self, after: frozenset[Believes], what: str, expected: str, got: str) -> None:
        if not after:
            raise Misfit(what, expected, got)
        self.possible = after


def said(gate: Gate) -> str:
    """A gate in words."""
    owner = ("UxAS", "ICAROUS")[gate.owner]
    return f"{owner} in epoch {gate.epoch}{', offered' if gate.offered else ''}"
