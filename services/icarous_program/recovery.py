"""Plans and zones with lost lines: held back until UxAS has sent the missing lines again.

An incomplete plan or zone is not in force. The received lines are kept here, and UxAS is asked for the rest a
bounded number of times; once complete, the lines go to the instance as if received at once. A line that
contradicts those kept starts a new plan or zone.
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
"""A request that is not answered is repeated after this long [ms]."""
PLAN, ZONE = "WAYPT", "GEOFN"
Key = tuple[str, int]
"""The kind, and the zone's number, 0 for the plan."""


class Part(NamedTuple):
    """The received part of a plan or zone. total: number of its lines, 0 if unknown; lines: by index; asked:
    how often UxAS was asked for the rest, at_ms: when last [ms].
    """

    key: Key
    total: int
    lines: Mapping[int, Message]
    asked: int = 0
    at_ms: int = 0

    @property
    def missing(self) -> list[int]:
        """The indices of the missing lines."""
        low = _lowest(self.key)
        return [k for k in range(low, low + self.total) if k not in self.lines]

    @property
    def whole(self) -> bool:
        """Whether no line is missing."""
        return bool(self.total) and not self.missing

    def __str__(self) -> str:
        what, number = self.key
        name = "plan" if what == PLAN else f"zone {number}"
        return f"{name}: {len(self.lines)} of {self.total or 'unknown'} lines are there"


Parts = Mapping[Key, Part]


class Taken(NamedTuple):
    """Result of a line. lost: the plan and zones still incomplete; told: lines for the instance now, in
    order; ask: the one to ask for, as its final line has arrived.
    """

    lost: Parts
    told: tuple[Message, ...]
    ask: Key | None = None


def of_plan(gathered: Iterable[Waypoint]) -> Part:
    """An incomplete plan. Requires at least one line."""
    lines = {w.index: w for w in gathered}
    last = list(lines.values())[-1]
    return _part((PLAN, 0), last.total, lines, len({w.total for w in lines.values()}) == 1)


def of_zone(number: int, vertices: Iterable[FenceVertex]) -> Part:
    """An incomplete zone."""
    mine = {v.vertex: v for v in vertices if v.zone == number}
    kinds = {(v.fence, v.total, v.floor_m, v.ceiling_m) for v in mine.values()}
    total = next((v.total for v in mine.values()), 0)
    return _part((ZONE, number), total, mine, len(kinds) == 1)


def _part(key: Key, total: int, lines: Mapping[int, Message], alike: bool) -> Part:
    """A part with its lines; if they contradict each other, all count as missing."""
    part = Part(key, total, lines)
    sound = alike and part.missing and len(part.missing) + len(lines) == total
    return part if sound else Part(key, total, {})


def take(lost: Parts, line: Message) -> Taken:
    """Process a line from UxAS."""
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
    """The part after asking once more, and the line to UxAS; None if the limit is reached.

    UxAS answers MOST_AGAIN times; by the request after that it knows that the plan or zone is not in force.
    """
    if part.asked not in range(MOST_AGAIN + 1):
        return None
    (what, number), missing = part.key, part.missing
    low = _lowest(part.key)
    first, last = (missing[0], missing[-1]) if missing else (low, max(0, low + part.total - 1))
    line = LinesMissing(what, number, part.total, first, last)
    return part._replace(asked=part.asked + 1, at_ms=now_ms), line


def _lowest(key: Key) -> int:
    """Lowest index: waypoints count from 0, vertices from 1."""
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
