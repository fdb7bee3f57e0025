"""Routes along roads between places near a road, and road crossings of a circle.

A place beside a road is represented by the nearest point of the nearest leg. The kernel `crossings`, proved
to miss none, counts the crossings of a leg with a circle. Plane and units: north and east [m] of a frame in
the middle of the map.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterator
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from cratous.core.kernel import Vec2
from cratous.core.tasks.cordon import crossings
from cratous.core.tasks.stations import in_ring
from cratous.services.mission.frames import Projection
from cratous.services.roads.osm import RoadMap
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

WIDEST_M = 200_000.0
"""Largest extent of a map from its centre [m]: beyond, distances in a single plane are too inaccurate."""
OFF_ROAD_MOST_M = 1_000.0
"""A place farther than this from every road is not on the network [m]."""
SAME_M = 1.0
"""Crossings no farther apart than this are merged: roads that meet on the circle [m]."""
_START, _END = -1, -2

Clear = Callable[[Vec2, Vec2], bool]
"""Whether a straight leg may be driven."""


class Foot(NamedTuple):
    """A place, the nearest point on a road, and the number of that leg."""

    place: Vec2
    at: Vec2
    leg: int


class Crossing(NamedTuple):
    """A crossing of a road with a circle, and the road's outward direction there (clockwise from north)
    [rad].
    """

    at: Vec2
    heading_rad: float


class Network:
    """The roads of a map in one plane. Immutable."""

    def __init__(self, roads: RoadMap, where: str) -> None:
        """BadInput if the map is too wide for one plane. where: name of the map."""
        index = {ref: k for k, ref in enumerate(roads.nodes)}
        lats, lons = zip(*roads.nodes.values(), strict=True)
        middle = [(min(part) + max(part)) / 2 for part in (lats, lons)]
        self.projection = Projection(Frame(*middle))
        norths, easts = self.projection.to_local_many(lats, lons)
        self.nodes = [Vec2(float(n), float(e)) for n, e in zip(norths, easts, strict=True)]
        for ref, node in zip(roads.nodes, self.nodes, strict=True):
            if not in_ring(Vec2(0.0, 0.0), node, 0.0, WIDEST_M):
                raise BadInput(
                    "a map that is too wide", where=where, item=f"node {ref}",
                    expected=f"no more than {WIDEST_M / 1000:g} km from its middle",
                    got=f"{math.hypot(*node) / 1000:.0f} km",
                )  # fmt: skip
        pairs = {
            (min(index[a], index[b]), max(index[a], index[b]))
            for run in roads.roads
            for a, b in pairwise(run)
        }
        self.legs = sorted(pairs)
        self._beside: list[list[int]] = [[] for _ in self.nodes]
        for a, b in self.legs:
            self._beside[a].append(b)
            self._beside[b].append(a)

    @cached_property
    def _table(self) -> tuple[np.ndarray, np.ndarray]:
        """Start and direction vector of each leg."""
        begins = np.array([self.nodes[a] for a, _ in self.legs])
        return begins, np.array([self.nodes[b] for _, b in self.legs]) - begins

    def foot(self, place: Vec2) -> Foot | None:
        """The road point nearest to a place; None if it is farther than OFF_ROAD_MOST_M."""
        begins, along = self._table
        to = np.asarray(place) - begins
        lengths = np.maximum((along**2).sum(axis=1), 1e-12)
        share = np.clip((to * along).sum(axis=1) / lengths, 0.0, 1.0)
        points = begins + share[:, None] * along
        leg = int(((points - np.asarray(place)) ** 2).sum(axis=1).argmin())
        at = Vec2(*map(float, points[leg]))
        return Foot(place, at, leg) if in_ring(place, at, 0.0, OFF_ROAD_MOST_M) else None

    def way(self, start: Foot, end: Foot, clear: Clear | None = None) -> tuple[Vec2, ...]:
        """The shortest route along roads between two feet; () if there is none.

        clear: which legs may be driven, None: all.
        """
        may = clear or (lambda p, q: True)
        came: dict[int, int] = {}
        # sorted by the length so far plus the straight-line distance left
        todo: list[tuple[float, float, int, int]] = [(0.0, 0.0, _START, _START)]
        while todo:
            _, gone, node, before = heapq.heappop(todo)
            if node in came:
                continue
            came[node] = before
            if node == _END:
                return _distinct(self._traced(came, start, end))
            here = self._at(node, start, end)
            for other in self._next(node, start, end):
                there = self._at(other, start, end)
                if other not in came and may(here, there):
                    so_far = gone + math.dist(here, there)
                    least = so_far + math.dist(there, end.at)
                    heapq.heappush(todo, (least, so_far, other, node))
        return ()

    def _next(self, node: int, start: Foot, end: Foot) -> Iterator[int]:
        """The successors of a node; from the start, those of its leg."""
        if node == _START:
            yield from self.legs[start.leg]
            if start.leg == end.leg:
                yield _END
            return
        yield from self._beside[node]
        if node in self.legs[end.leg]:
            yield _END

    def _at(self, node: int, start: Foot, end: Foot) -> Vec2:
        if node == _START:
            return start.at
        return end.at if node == _END else self.nodes[node]

    def _traced(self, came: dict[int, int], start: Foot, end: Foot) -> Iterator[Vec2]:
        nodes = [_END]
        while nodes[-1] != _START:
            nodes.append(came[nodes[-1]])
        return (self._at(node, start, end) for node in reversed(nodes))

    def crossings(self, middle: Vec2, radius_m: float) -> tuple[Crossing, ...]:
        """The crossings of roads with a circle, by bearing from its centre, north first.

        Tangent roads do not count; a road that crosses several times is listed several times.
        """
        found: list[Crossing] = []
        for a, b in self.legs:
            for one in _crossed(middle, radius_m, self.nodes[a], self.nodes[b]):
                if not any(in_ring(one.at, known.at, 0.0, SAME_M) for known in found):
                    found.append(one)
        return tuple(sorted(found, key=lambda one: _bearing(middle, one.at)))

    def local(self, latitude_deg: float, longitude_deg: float) -> Vec2:
        """A place in degrees in the plane of the map."""
        return Vec2(*self.projection.to_local(latitude_deg, longitude_deg))


def length_m(points: tuple[Vec2, ...]) -> float:
    """Length of a route [m]."""
    return sum(math.dist(p, q) for p, q in pairwise(points))


def _distinct(points: Iterator[Vec2]) -> tuple[Vec2, ...]:
    """The points without consecutive duplicates."""
    kept: list[Vec2] = []
    for point in points:
        if not kept or kept[-1] != point:
            kept.append(point)
    return tuple(kept)


def _bearing(middle: Vec2, at: Vec2) -> float:
    return math.atan2(at.y - middle.y, at.x - middle.x) % (2 * math.pi)


def _crossed(middle: Vec2, radius_m: float, a: Vec2, b: Vec2) -> Iterator[Crossing]:
    """The crossings of a leg with a circle, as many as the kernel counts."""
    count = crossings(middle, a, b, radius_m)
    if not count:
        return
    north, east = b.x - a.x, b.y - a.y
    square = north * north + east * east
    half = ((a.x - middle.x) * north + (a.y - middle.y) * east) / square
    ahead = ((a.x - middle.x) ** 2 + (a.y - middle.y) ** 2 - radius_m**2) / square
    spread = math.sqrt(max(half * half - ahead, 0.0))
    heading = math.atan2(east, north)
    ways = [(-half - spread, heading + math.pi), (-half + spread, heading)]
    if count == 1:  # outward if it begins inside
        ways = ways[1:] if in_ring(middle, a, 0.0, radius_m) else ways[:1]
    for share, outwards in ways:
        t = min(max(share, 0.0), 1.0)
        yield Crossing(Vec2(a.x + t * north, a.y + t * east), outwards)
