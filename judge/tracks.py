"""The flown path of each aircraft: straight legs between logged states, and its flaws.

A leg is assumed to be straight. A logged state also has the velocity of the next leg, so this can
be checked: if it does not lead to the next position, the path in between is unknown.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from cratous.judge.log import Log, State
from cratous.judge.mission import Mission
from cratous.judge.verdict import seconds

APART_M = 1e-3
"""Tolerance between a leg's end and the position given by its velocity [m]."""


class Flaw(NamedTuple):
    """Time span in which the path is unknown, and why."""

    first_ms: int
    last_ms: int
    why: str


@dataclass
class Track:
    """States in time order, and where the path is unknown.

    unknown: start times of legs of which only the ends are known.
    """

    states: list[State]
    times: list[int]
    flaws: list[Flaw] = field(default_factory=list)
    unknown: set[int] = field(default_factory=set)

    def legs(self, first: int = 0) -> Iterator[tuple[State, State]]:
        """All legs from this state on; if only its ends are known, each end as a leg of its own."""
        states = self.states[first:]
        if len(states) == 1:
            yield states[0], states[0]
        for before, after in pairwise(states):
            if before.time_ms in self.unknown:
                yield before, before
                yield after, after
            else:
                yield before, after

    @property
    def doubt(self) -> str:
        """Why the path is not known throughout; empty if it is."""
        return self.flaws[0].why if self.flaws else ""

    def doubt_before(self, time_ms: int | None) -> str:
        """Why the path is not known throughout up to an instant; None: to the end."""
        if time_ms is None:
            return self.doubt
        return next((flaw.why for flaw in self.flaws if flaw.first_ms < time_ms), "")

    def from_index(self, time_ms: int) -> int:
        """Index of the first state at or after an instant."""
        return bisect_left(self.times, time_ms)


def tracks(mission: Mission, log: Log) -> dict[int, Track]:
    """The track of every aircraft of the mission or the log."""
    names = {*mission.vehicles, *(t.id for t in mission.traffic), *log.states}
    return {name: _track(name, mission, log) for name in sorted(names)}


def _track(name: int, mission: Mission, log: Log) -> Track:
    found = Track([], [])
    for state in log.states.get(name, []):
        if found.times and state.time_ms <= found.times[-1]:
            text = f"the positions of {name} are not in the order of time"
            found.flaws.append(Flaw(state.time_ms, state.time_ms, text))
            continue
        found.states.append(state)
        found.times.append(state.time_ms)
    begin, end = _span(name, mission, log)
    if not found.states:
        if begin is not None and (end is None or begin <= end):
            last = begin if end is None else end
            found.flaws.append(Flaw(begin, last, f"no position of {name} was logged"))
        return found
    _ends(found, name, begin, end, mission.step_ms)
    for before, after in pairwise(found.states):
        gap = after.time_ms - before.time_ms
        if gap > mission.step_ms:
            text = f"no position of {name} from {seconds(before.time_ms)} for {gap} ms"
            found.flaws.append(Flaw(before.time_ms, after.time_ms, text))
            found.unknown.add(before.time_ms)
        elif not _led(before, after):
            text = (
                f"the position of {name} at {seconds(after.time_ms)} is not where its velocity led"
            )
            found.flaws.append(Flaw(before.time_ms, after.time_ms, text))
            found.unknown.add(before.time_ms)
    return found


def _span(name: int, mission: Mission, log: Log) -> tuple[int | None, int | None]:
    """The time span in which an aircraft has to be logged."""
    if name in mission.vehicles:
        return 0, log.end_ms
    for traffic in mission.traffic:
        if traffic.id == name:
            end = log.end_ms
            if traffic.vanishes_ms is not None and end is not None:
                end = min(end, traffic.vanishes_ms)
            return traffic.appears_ms, end
    return None, None


def _ends(track: Track, name: int, begin: int | None, end: int | None, step_ms: int) -> None:
    # an aircraft that appears or disappears between two steps is first and last seen at a step
    if begin is not None and track.times[0] - begin >= max(1, step_ms if begin else 1):
        text = f"no position of {name} before {seconds(track.times[0])}"
        track.flaws.append(Flaw(begin, track.times[0], text))
    if end is not None and end - track.times[-1] >= step_ms:
        text = f"no position of {name} after {seconds(track.times[-1])}"
        track.flaws.append(Flaw(track.times[-1], end, text))


def _led(before: State, after: State) -> bool:
    begun, north, east, up, to_north, to_east, upwards = before
    time, there_north, there_east, there_up, *_ = after
    dt = (time - begun) / 1000
    off = (
        abs(north + to_north * dt - there_north),
        abs(east + to_east * dt - there_east),
        abs(up + upwards * dt - there_up),
    )
    if off[0] <= APART_M and off[1] <= APART_M and off[2] <= APART_M:
        return True
    places = (north, east, up, there_north, there_east, there_up)
    most = max(off)
    return most <= APART_M + 1e-12 * max(map(abs, places)) and math.isfinite(most)
