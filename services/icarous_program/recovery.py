"""Lines of a plan or zone that got lost on the way: held back until UxAS has sent the missing ones again.

A plan or zone that is not whole is not in force. What came of it is kept here, UxAS is asked for the rest,
a bounded number of times, and once all is there the lines go to the instance as if they had come at once.
A line that does not fit what is kept begins something new.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from cratous.bridge.text_protocol import (
    FenceDone,
    FenceVertex,
    ForgetFences,
    ForgetWaypoints,
    HardReset,
    LinesMissing,
    Message,
    SoftReset,
    StartMission,
    Waypoint,
)
from cratous.services.flight.link_lines import MOST_AGAIN

ASK_AGAIN_MS = 1000
"""An answer that has not come for this long [ms] is asked for again."""
PLAN, ZONE = "WAYPT", "GEOFN"
Key = tuple[str, int]
"""What it is, and the zone's number, 0 for the plan."""


class Part(NamedTuple):
    """What is there of a plan or zone. total: its lines, 0 if not known; lines: by index; asked: how
    often UxAS was asked for the rest, at_ms: when last [ms]."""

    key: Key
    total: int
    lines: Mapping[int, Message]
    asked: int = 0
    at_ms: int = 0

    @property
    def missing(self) -> list[int]:
        """The indices of the lines that are not there."""
        low = _lowest(self.key)
        return [k for k in range(low, low + self.total) if k not in self.lines]

    @property
    def whole(self) -> bool:
        """True if nothing is missing."""
        return bool(self.total) and not self.missing

    def __str__(self) -> str:
        what, number = self.key
        name = "plan" if what == PLAN else f"zone {number}"
        return f"{name}: {len(self.lines)} of {self.total or 'unknown'} lines are there"


Parts = Mapping[Key, Part]


class Taken(NamedTuple):
    """After a line. lost: what is still not whole; told: what the instance hears now, in order; ask: what
    to ask for again, as its last line has come."""

    lost: Parts
    told: tuple[Message, ...]
    ask: Key | None = None


def of_plan(gathered: Iterable[Waypoint]) -> Part:
    """A plan, of which at least one line has come, that is not whole."""
    lines = {w.index: w for w in gathered}
    last = list(lines.values())[-1]
    return _part((PLAN, 0), last.total, lines, len({w.total for w in lines.values()}) == 1)


def of_zone(number: int, vertices: Iterable[FenceVertex]) -> Part:
    """A zone that is not whole."""
    mine = {v.vertex: v for v in vertices if v.zone == number}
    kinds = {(v.fence, v.total, v.floor_m, v.ceiling_m) for v in mine.values()}
    total = next((v.total for v in mine.values()), 0)
    return _part((ZONE, number), total, mine, len(kinds) == 1)


def _part(key: Key, total: int, lines: Mapping[int, Message], alike: bool) -> Part:
    """Lines that contradict each other say nothing: then all are missing."""
    part = Part(key, total, lines)
    sound = alike and part.missing and len(part.missing) + len(lines) == total
    return part if sound else Part(key, total, {})


def take(lost: Parts, line: Message) -> Taken:
    """A line has come from UxAS."""
    match line:
        case HardReset():
            return Taken({}, (line,))
        case ForgetFences():
            return Taken({key: part for key, part in lost.items() if key[0] != ZONE}, (line,))
        case SoftReset(None) | ForgetWaypoints():
            return Taken(_without(lost, (PLAN, 0)), (line,))
        case Waypoint(total=total, index=index):
            return _line(lost, (PLAN, 0), total, index, line)
        case FenceVertex(total=total, vertex=index, zone=zone):
            return _line(lost, (ZONE, zone), total, index, line)
        case StartMission():
            return _end(lost, (PLAN, 0), line)
        case FenceDone(zone) if zone is not None:
            return _end(lost, (ZONE, zone), line)
    return Taken(lost, (line,))


def asked(part: Part, now_ms: int) -> tuple[Part, LinesMissing] | None:
    """The same after asking once more, and the line to UxAS; None if it was asked often enough.

    UxAS answers MOST_AGAIN times; by the one after that it knows that the plan or zone is not in force.
    """
    if part.asked not in range(MOST_AGAIN + 1):
        return None
    (what, number), missing = part.key, part.missing
    low = _lowest(part.key)
    first, last = (missing[0], missing[-1]) if missing else (low, max(0, low + part.total - 1))
    line = LinesMissing(what, number, part.total, first, last)
    return part._replace(asked=part.asked + 1, at_ms=now_ms), line


def _lowest(key: Key) -> int:
    """Waypoints are counted from 0, vertices from 1."""
    return 0 if key[0] == PLAN else 1


def _line(lost: Parts, key: Key, total: int, index: int, line: Message) -> Taken:
    part = lost.get(key)
    if part is None:
        return Taken(lost, (line,))
    known = part.lines.get(index, line)
    if known != line or total not in (part.total, part.total or total):
        return Taken(_without(lost, key), (line,))
    after = part._replace(total=total, lines={**part.lines, index: line})
    return Taken({**lost, key: after}, ())


def _end(lost: Parts, key: Key, line: Message) -> Taken:
    part = lost.get(key)
    if part is None:
        return Taken(lost, (line,))
    if not part.whole:
        return Taken(lost, (), key)
    lines = tuple(part.lines[k] for k in sorted(part.lines))
    return Taken(_without(lost, key), (*lines, line))


def _without(lost: Parts, key: Key) -> Parts:
    return {k: part for k, part in lost.items() if k != key}
