"""Fraction of a line or an area where zones forbid flight: noted on a search that was not served.

Estimated from evenly spread points, each checked against each zone like any position of a flight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from cratous.judge.coverage import outlines
from cratous.judge.log import State
from cratous.judge.mission import Point, Task
from cratous.judge.plane import winding
from cratous.judge.task_presence import Flight
from cratous.judge.zones import Fence

POINTS = 2_000
"""Approximate number of points."""


def forbidden_note(flight: Flight, task: Task) -> str:
    """The fraction at the altitude at which the task was begun, and the zones; empty if it is zero."""
    spans = flight.spans(task.id)
    if task.kind == "point_search" or not spans or flight.log.end_ms is None:
        return ""
    vehicle, start, _ = spans[0]
    track = flight.tracks.get(vehicle)
    index = track.from_index(start) if track else 0
    if track is None or index >= len(track.states):
        return ""
    here = track.states[index]
    end_ms = flight.log.end_ms
    known = [z for z in flight.mission.zones if z.from_ms <= end_ms and not z.over(end_ms)]
    fences = [(zone.id, Fence(zone)) for zone in known]
    points, met, names = 0, 0, set[int]()
    for north_m, east_m in _points(task):
        points += 1
        state = here._replace(north_m=north_m, east_m=east_m)
        broken = {number for number, fence in fences if _breaks(fence, state)}
        names |= broken
        met += bool(broken)
    if not met:
        return ""
    said = ", ".join(map(str, sorted(names)))
    return f"; about {100 * met / points:.0f} % of it lies in zone {said} at {here.alt_m:.0f} m"


def _breaks(fence: Fence, state: State) -> bool:
    return fence.breaks(state, state)


def _points(task: Task) -> Iterator[Point]:
    """Points along a line, or of a grid over an area."""
    if task.kind == "line_search":
        whole = sum(math.dist(p, q) for p, q in pairwise(task.points))
        step = max(whole / POINTS, 1e-3)
        for p, q in pairwise(task.points):
            count = max(1, round(math.dist(p, q) / step))
            for k in range(count):
                t = (k + 0.5) / count
                yield p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])
        return
    ring = outlines(task)[0]
    low = [min(p[k] for p in ring) for k in (0, 1)]
    high = [max(p[k] for p in ring) for k in (0, 1)]
    side = max(math.sqrt((high[0] - low[0]) * (high[1] - low[1]) / POINTS), 1e-3)
    for i in range(math.ceil((high[0] - low[0]) / side)):
        for j in range(math.ceil((high[1] - low[1]) / side)):
            point = (low[0] + (i + 0.5) * side, low[1] + (j + 0.5) * side)
            if winding(ring, point) != 0:
                yield point
