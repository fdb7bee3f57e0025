"""Which vehicle was at which task when, on which path, and whether that is known."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from cratous.judge.earth import to_local
from cratous.judge.log import Log
from cratous.judge.mission import Mission, Point, Task
from cratous.judge.relations import Deed
from cratous.judge.tracks import Track
from cratous.judge.verdict import seconds

SAME_M = 0.1
"""Tolerance between a vehicle's true and reported position [m]."""


@dataclass
class Flight:
    """Everything by which service is judged. done: logged execution by task."""

    mission: Mission
    log: Log
    tracks: dict[int, Track]
    done: dict[int, Deed]

    def spans(self, task: int) -> list[tuple[int, int, int]]:
        """The vehicles at the task, with start and end."""
        end = self.log.end_ms
        found = []
        for vehicle, start, stop in self.done.get(task, Deed()).active:
            until = stop if stop is not None else end
            if until is not None and until >= start:
                found.append((vehicle, start, until))
        return found

    def legs(self, task: int) -> Iterator[tuple[Point, Point, float]]:
        """The legs flown while at the task, clipped to it, with their duration [ms]."""
        for vehicle, start, stop in self.spans(task):
            track = self.tracks.get(vehicle)
            if track is None:
                continue
            for k in range(max(track.from_index(start) - 1, 0), len(track.states) - 1):
                a, b = track.states[k], track.states[k + 1]
                if a.time_ms > stop:
                    break
                first, last = max(a.time_ms, start), min(b.time_ms, stop)
                if first > last:
                    continue
                if a.time_ms in track.unknown:
                    for state in (a, b):
                        if start <= state.time_ms <= stop:
                            here = (state.north_m, state.east_m)
                            yield here, here, 0
                    continue
                gap = b.time_ms - a.time_ms
                ends = []
                for at in (first, last):
                    t = (at - a.time_ms) / gap
                    ends.append(
                        (a.north_m + t * (b.north_m - a.north_m),
                         a.east_m + t * (b.east_m - a.east_m))
                    )  # fmt: skip
                yield ends[0], ends[1], last - first

    def doubt(self, task: int) -> str:
        """Why the execution of the task is not known; empty if it is."""
        deed = self.done.get(task)
        return self.way_doubt(task) or (deed.fault if deed else "")

    def way_doubt(self, task: int) -> str:
        """Why the path of its vehicles is not known; empty if it is."""
        for vehicle, start, stop in self.spans(task):
            track = self.tracks.get(vehicle)
            if track is None or not track.states:
                return f"no position of {vehicle} was logged"
            for flaw in track.flaws:
                if flaw.first_ms <= stop and flaw.last_ms >= start:
                    return flaw.why
            for time_ms in track.times[track.from_index(start) :]:
                if time_ms > stop:
                    break
                if not self._where_it_says(vehicle, time_ms):
                    return f"{vehicle} says at {seconds(time_ms)} that it is elsewhere than it is"
        return ""

    def _where_it_says(self, vehicle: int, time_ms: int) -> bool:
        """Whether the position reported with a footprint is the true one, so that the frames agree."""
        said = self.log.places.get((vehicle, time_ms))
        if said is None:
            return True
        track, mission = self.tracks[vehicle], self.mission
        state = track.states[track.from_index(time_ms)]
        local = to_local(mission.latitude_deg, mission.longitude_deg, *said)
        here = (state.north_m, state.east_m)
        return local is not None and math.dist(local, here) <= SAME_M


def nearest_m(flight: Flight, task: Task, point: Point) -> float:
    """Closest distance to a point of the vehicles that performed a task, while doing so [m]."""
    found = math.inf
    for a, b, _ in flight.legs(task.id):
        found = min(found, _distance(point, a, b))
    return found


def _distance(p: Point, a: Point, b: Point) -> float:
    u, w = (b[0] - a[0], b[1] - a[1]), (p[0] - a[0], p[1] - a[1])
    length = u[0] * u[0] + u[1] * u[1]
    t = min(max((w[0] * u[0] + w[1] * u[1]) / length, 0.0), 1.0) if length else 0.0
    return math.hypot(w[0] - t * u[0], w[1] - t * u[1])
