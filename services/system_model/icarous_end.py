"""Model of one vehicle's ICAROUS instance: the set of all states consistent with the log.

What an instance observes is not in the log: whether a conflict is predicted, whether the return
path is clear, when it heard UxAS. Each may be either way; the flown kernels decide what it does
then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cratous.core.authority.cycle import (
    Cycle,
    Cycled,
    cycle_begun,
    cycle_flown,
    cycle_watched,
    gate_wished,
)
from cratous.core.authority.gate import ICAROUS, Gate, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.services.icarous.instance import LINK_LOST_MS
from cratous.services.icarous.return_to_path import PERSIST_MS, RELAPSE_MS
from cratous.services.system_model.finding import Misfit
from cratous.spec.authority.cycle import MONITOR, NOTHING

START = Cycle(MONITOR, 0, False, 0, False, 0)
TOO_LONG_MS = LINK_LOST_MS + 1
ASKED = {
    "wish": "what ICAROUS may do with its authority then (take over, offer or withdraw)",
    "command": "no command, for ICAROUS does not fly the vehicle, or has commanded at this heartbeat already",
    "silence": "a command of ICAROUS, which flies the vehicle, at this heartbeat",
}


class IcarousEnd:
    """cycles: possible states; beats: number of heartbeats; beat_ms: time of the last [ms], None
    before the first; due: a command has to follow a change of authority; flown: it has commanded
    before.
    """

    def __init__(self) -> None:
        self.cycles: frozenset[Cycle] = frozenset({START})
        self.beats = 0
        self.beat_ms: int | None = None
        self.due = False
        self.flown = False

    def has_beaten(self, now_ms: int) -> bool:
        """True if its heartbeat at this instant has started or is over."""
        return self.beat_ms is not None and in_time(self.beat_ms, now_ms, 0)

    def wishes(self, gate: Gate, after: Gate, now_ms: int) -> None:
        """It changed the gate in its heartbeat; Misfit if no possible state does this."""
        got = f"the gate went from {tuple(gate)} to {tuple(after)} (owner, epoch, offered)"
        self._beat(
            gate,
            now_ms,
            lambda does: does.act != NOTHING and gate_wished(gate, does.act) == after,
            ASKED["wish"],
            got,
        )
        self.due = True

    def commands(self, gate: Gate, now_ms: int) -> None:
        """It sends a command; Misfit if no possible state allows this, or this heartbeat already
        has its command.
        """
        self.flown = True
        if self.due:
            self.due = False
            return
        got = f"a command of ICAROUS; the gate is {tuple(gate)}"
        self._beat(gate, now_ms, _goes_on, ASKED["command"], got)

    def is_silent(self, gate: Gate, now_ms: int) -> None:
        """Its heartbeat passes without any output; Misfit if it has to command."""
        self._beat(gate, now_ms, _watches, ASKED["silence"], "none")

    def _beat(
        self, gate: Gate, now_ms: int, fits: Callable[[Cycled], bool], expected: str, got: str
    ) -> None:
        if self.has_beaten(now_ms):
            raise Misfit("a second heartbeat of ICAROUS at one instant", expected, got)
        after = frozenset(d.cycle for d in self._may_do(gate, now_ms) if fits(d))
        if not after:
            raise Misfit("a heartbeat of ICAROUS", expected, got)
        self.cycles, self.beat_ms = _foremost(after), now_ms
        self.beats += 1

    def _may_do(self, gate: Gate, now_ms: int) -> Iterator[Cycled]:
        """All possible transitions, for any observations."""
        may = gate_accepts(gate, ICAROUS, gate.epoch)
        for cycle in self.cycles:
            begun = cycle_begun(cycle, may, now_ms)
            for seen in (False, True):
                if begun.mode == MONITOR:
                    yield cycle_watched(begun, seen, now_ms, RELAPSE_MS)
                    continue
                for heard_ms in (now_ms, now_ms - TOO_LONG_MS):
                    yield cycle_flown(begun, seen, heard_ms, now_ms, LINK_LOST_MS, PERSIST_MS)


def _goes_on(does: Cycled) -> bool:
    return does.act == NOTHING and does.cycle.mode != MONITOR


def _watches(does: Cycled) -> bool:
    return does.act == NOTHING and does.cycle.mode == MONITOR


def _foremost(cycles: frozenset[Cycle]) -> frozenset[Cycle]:
    """Drop states that allow nothing more than another: of states that differ only in the time
    since which the return path is clear, the earliest may offer whenever any other may, and need
    not.
    """
    longest: dict[Cycle, Cycle] = {}
    for cycle in cycles:
        alike = cycle._replace(free_ms=0)
        longest[alike] = min(longest.get(alike, cycle), cycle)
    return frozenset(longest.values())
