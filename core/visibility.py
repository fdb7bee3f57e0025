"""Flyable routes around zones: visibility graph, shortest path, turns, and a check of every leg.

A `Roadmap` holds the zones of one altitude regime and rings of via points around them, from the
tightest ring to the widest (made by offsetting outside `core`). A route is the direct Dubins path
if the zones allow it. Otherwise the shortest chain of via points is searched (A*), joined by
Dubins pieces, and every leg of the result is put to the proved kernels; a piece that they refuse
is struck from the graph, or tried with other headings, or on a wider ring. All loops are bounded.
"""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.core.dubins import (
    RIGHT,
    DubinsPath,
    cut,
    dubins_paths,
    polyline_length_m,
    pose_after,
)
from cratous.core.kernel import driver
from cratous.core.legs import first_bad_leg, leg_ok
from cratous.spec.mission import Position, Zone
from cratous.spec.plan import Pose

ALTERNATIVES = 12
"""How many chains of via points are tried per ring before the next ring."""


class Route(NamedTuple):
    """A flyable polyline and its length [m], or no points and the reason."""

    points: tuple[Position, ...]
    length_m: float
    reason: str = ""


@dataclass
class Roadmap:
    """Zones, via points (north, east) per ring, and a memory of which via legs are allowed."""

    zones: tuple[Zone, ...]
    rings: tuple[tuple[tuple[float, float], ...], ...] = ()
    chord_error_m: float = 0.5
    _seen: dict[tuple[float, ...], bool] = field(default_factory=dict)

    def sees(self, p: tuple[float, float], q: tuple[float, float], alt_m: float) -> bool:
        """True iff the level straight leg from p to q obeys all zones."""
        key = (*min(p, q), *max(p, q), alt_m)
        if key not in self._seen:
            a, b = Position(*p, alt_m), Position(*q, alt_m)
            self._seen[key] = all(leg_ok(a, b, zone) for zone in self.zones)
        return self._seen[key]


def _climbing(start: Pose, end: Pose, radius_m: float, max_slope: float) -> list[DubinsPath]:
    """Dubins words, with full turns put in front where the way is too short for the climb."""
    paths = dubins_paths(start, end, radius_m)
    need = abs(end.alt_m - start.alt_m) / max_slope if end.alt_m != start.alt_m else 0.0
    if need <= 0:
        return paths
    lap = 2 * math.pi * radius_m
    made = []
    for path in paths:
        laps = max(0, math.ceil((need - path.length_m) / lap))
        made.append(path._replace(lengths_m=(path.lengths_m[0] + laps * lap, *path.lengths_m[1:])))
    return sorted(made, key=lambda path: path.length_m)


def _piece(
    start: Pose, end: Pose, radius_m: float, roadmap: Roadmap, max_slope: float
) -> tuple[tuple[Position, ...], float] | Zone:
    """The shortest allowed word from start to end, or the zone that forbids the shortest one."""
    blocked: Zone | None = None
    for path in _climbing(start, end, radius_m, max_slope):
        points = cut(path, end, roadmap.chord_error_m)
        bad = first_bad_leg(points, roadmap.zones)
        if bad is None:
            return points, polyline_length_m(points)
        blocked = blocked or bad[1]
    assert blocked is not None
    return blocked


def _chain(
    start: tuple[float, float],
    end: tuple[float, float],
    alt_m: float,
    ring: Sequence[tuple[float, float]],
    struck: set[tuple[tuple[float, float], tuple[float, float]]],
    roadmap: Roadmap,
) -> list[tuple[float, float]] | None:
    """Shortest chain of mutually visible points from start to end (A*), struck pairs left out."""
    order = itertools.count()
    heap: list[tuple[float, int, float, tuple[float, float]]] = [
        (math.dist(start, end), next(order), 0.0, start)
    ]
    best: dict[tuple[float, float], float] = {start: 0.0}
    before: dict[tuple[float, float], tuple[float, float]] = {}
    closed: set[tuple[float, float]] = set()
    while heap:
        _, _, length, at = heapq.heappop(heap)
        if at in closed:
            continue
        closed.add(at)
        if at == end:
            chain = [end]
            while chain[-1] != start:
                chain.append(before[chain[-1]])
            return chain[::-1]
        for to in (*ring, end):
            if to in closed or to == at or (at, to) in struck:
                continue
            longer = length + math.dist(at, to)
            if longer < best.get(to, math.inf) and roadmap.sees(at, to, alt_m):
                best[to], before[to] = longer, at
                heapq.heappush(heap, (longer + math.dist(to, end), next(order), longer, to))
    return None


def _bearing(p: tuple[float, float], q: tuple[float, float]) -> float:
    return math.atan2(q[1] - p[1], q[0] - p[0])


def _headings(chain: Sequence[tuple[float, float]], k: int) -> tuple[float, float, float]:
    """Headings to try at via point k: halfway between the legs, along the first, the second."""
    first, second = _bearing(chain[k - 1], chain[k]), _bearing(chain[k], chain[k + 1])
    turn = math.remainder(second - first, 2 * math.pi)
    return first + turn / 2, first, second


def _fly_chain(
    start: Pose,
    end: Pose,
    radius_m: float,
    chain: Sequence[tuple[float, float]],
    roadmap: Roadmap,
    max_slope: float,
) -> tuple[tuple[Position, ...], float] | int:
    """The shortest allowed Dubins chain through the via points, or the index of the bad link."""
    total = sum(math.dist(p, q) for p, q in itertools.pairwise(chain)) or 1.0
    states: list[tuple[float, Pose, tuple[Position, ...]]] = [(0.0, start, (start_point(start),))]
    run = 0.0
    for k in range(1, len(chain)):
        run += math.dist(chain[k - 1], chain[k])
        if k == len(chain) - 1:
            targets = [end]
        else:
            alt = start.alt_m + (end.alt_m - start.alt_m) * run / total
            targets = [Pose(*chain[k], alt, h) for h in _headings(chain, k)]
        reached = []
        for target in targets:
            found = []
            for length, pose, points in states:
                piece = _piece(pose, target, radius_m, roadmap, max_slope)
                if not isinstance(piece, Zone):
                    found.append((length + piece[1], target, points + piece[0][1:]))
            if found:
                reached.append(min(found, key=lambda state: state[0]))
        if not reached:
            return k
        states = reached
    best = min(states, key=lambda state: state[0])
    return best[2], best[0]


def start_point(pose: Pose) -> Position:
    """The position of a pose."""
    return Position(pose.north_m, pose.east_m, pose.alt_m)


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok"))
def route(
    start: Pose,
    end: Pose,
    radius_m: float,
    roadmap: Roadmap,
    max_slope: float = math.inf,
) -> Route:
    """A short flyable route from start to end whose every leg obeys the roadmap's zones.

    radius_m: turn radius [m]; max_slope: steepest climb or descent (metres per metre flown).
    The route is the shortest that was found, not the shortest that exists.
    """
    direct = _piece(start, end, radius_m, roadmap, max_slope)
    if not isinstance(direct, Zone):
        flown, least = direct[1], dubins_paths(start, end, radius_m)[0].length_m
        # with a word that is not much longer than the unobstructed one there is little to gain
        if not roadmap.zones or flown <= 1.2 * least + radius_m:
            return Route(*direct)
    for point, name in ((start, "start"), (end, "end")):
        bad = first_bad_leg((start_point(point),), roadmap.zones)
        if bad is not None:
            return Route((), 0.0, f"its {name} breaks {name_of(bad[1])}")
    best = None if isinstance(direct, Zone) else direct
    here, there = (start.north_m, start.east_m), (end.north_m, end.east_m)
    for ring in roadmap.rings:
        struck: set[tuple[tuple[float, float], tuple[float, float]]] = set()
        for _ in range(ALTERNATIVES):
            chain = _chain(here, there, start.alt_m, ring, struck, roadmap)
            if chain is None:
                break
            flown_chain = _fly_chain(start, end, radius_m, chain, roadmap, max_slope)
            if isinstance(flown_chain, int):
                struck.add((chain[flown_chain - 1], chain[flown_chain]))
                continue
            if best is None or flown_chain[1] < best[1]:
                best = flown_chain
            break
        if best is not None:
            return Route(*best)
    assert isinstance(direct, Zone)
    return Route((), 0.0, f"no way around {name_of(direct)} was found")


def name_of(zone: Zone) -> str:
    """A zone in words: kind, id and label."""
    kind = "keep-in" if zone.kind.value == "keep_in" else "keep-out"
    return f"{kind} zone {zone.id}" + (f" ({zone.label})" if zone.label else "")


def circle(
    at: Pose, radius_m: float, clockwise: bool, chord_error_m: float = 0.5
) -> tuple[Position, ...]:
    """One full turn from a pose back to it, as a polyline."""
    kind = RIGHT if clockwise else -RIGHT
    step = 2 * math.acos(max(0.0, 1 - chord_error_m / radius_m)) * radius_m
    count = max(8, math.ceil(2 * math.pi * radius_m / step))
    around = 2 * math.pi * radius_m
    points = [start_point(pose_after(at, kind, around * k / count, radius_m)) for k in range(count)]
    return (*points, points[0])
