"""Coverage of a line or an area by footprints: a lower and an upper bound.

Footprints are convex polygons (others are omitted from the lower bound, and replaced by their
bounding box in the upper bound). A line is split where footprints begin and end. An area is divided
into squares, which are quartered wherever neither one footprint contains a square nor all miss it,
down to FINEST_M.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cratous.judge.earth import ACCURACY_M
from cratous.judge.mission import Point, Task

FINEST_M = 1.25
"""Approximate minimum size of squares [m]."""
COARSEST_M = 160.0
MOST_SQUARES = 400_000
ROUND = 256
"""Number of corners of a polygon that approximates a disc."""
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Footprints:
    """Half planes n.x <= d of each footprint: shape (m, k, 2) and (m, k); `sure`: it is convex."""

    normals: Floats
    offsets: Floats
    boxes: Floats
    sure: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.sure)

    def take(self, index: NDArray[np.intp]) -> Footprints:
        """The footprints with these indices."""
        return Footprints(
            self.normals[index], self.offsets[index], self.boxes[index], self.sure[index]
        )


def footprints(polygons: Sequence[Sequence[Point]]) -> Footprints:
    """The footprints as half planes; those with fewer corners than others repeat their last edge."""
    most = max((len(p) for p in polygons), default=3)
    normals, offsets = np.zeros((len(polygons), most, 2)), np.zeros((len(polygons), most))
    boxes, sure = np.zeros((len(polygons), 4)), np.zeros(len(polygons), np.bool_)
    for k, polygon in enumerate(polygons):
        p = np.array(polygon, float)
        boxes[k] = (*p.min(axis=0), *p.max(axis=0))
        edges = np.roll(p, -1, axis=0) - p
        p, edges = p[np.any(edges != 0, axis=1)], edges[np.any(edges != 0, axis=1)]
        if len(p) < 3:
            continue
        cross = edges[:, 0] * np.roll(edges[:, 1], -1) - edges[:, 1] * np.roll(edges[:, 0], -1)
        turns = np.abs(
            np.sum(np.arctan2(cross, np.sum(edges * np.roll(edges, -1, axis=0), axis=1)))
        )
        sure[k] = (np.all(cross > 0) or np.all(cross < 0)) and turns < 7
        sign = 1.0 if cross.sum() > 0 else -1.0
        normal = sign * np.column_stack([edges[:, 1], -edges[:, 0]])
        normal /= np.hypot(*normal.T)[:, None]
        rows = np.minimum(np.arange(most), len(p) - 1)
        normals[k], offsets[k] = normal[rows], np.sum(normal * p, axis=1)[rows]
    return Footprints(normals, offsets, boxes, sure)


def point_seen(prints: Footprints, point: Point) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which footprints certainly contain a point, and which may."""
    n, e = point
    over = np.max(prints.normals @ np.array(point, float) - prints.offsets, axis=1)
    box = prints.boxes
    boxed = (box[:, 0] <= n) & (n <= box[:, 2]) & (box[:, 1] <= e) & (e <= box[:, 3])
    certain = prints.sure & (over <= -ACCURACY_M)
    return certain, np.where(prints.sure, over <= ACCURACY_M, boxed)


def line_seen(prints: Footprints, points: Sequence[Point]) -> tuple[float, float, float]:
    """Lengths of a polyline that are certainly seen, and possibly seen, and its total length [m]."""
    sure = may = whole = 0.0
    for p, q in pairwise(points):
        length = math.dist(p, q)
        if length == 0:
            continue
        whole += length
        low, high = _spans(prints, p, q, length)
        sure += length * _union(low)
        may += length * _union(high)
    return sure, may, whole


Spans = list[tuple[float, float]]


def _spans(prints: Footprints, p: Point, q: Point, length: float) -> tuple[Spans, Spans]:
    """The parts of a segment in each footprint, as parameters from 0 to 1: certain, possible."""
    start, way = np.array(p), np.array(q) - np.array(p)
    low: Spans = []
    high: Spans = []
    at, rate = prints.normals @ start - prints.offsets, prints.normals @ way
    for k in range(len(prints)):
        for spans, room in ((low, -ACCURACY_M), (high, ACCURACY_M)):
            if not prints.sure[k]:
                if spans is high:
                    spans.append((0.0, 1.0))
                continue
            first, last = 0.0, 1.0
            for s, v in zip(at[k].tolist(), rate[k].tolist(), strict=True):
                # s + v t <= room
                if v > 0:
                    last = min(last, (room - s) / v)
                elif v < 0:
                    first = max(first, (room - s) / v)
                elif s > room:
                    last = -1.0
            if first < last:
                spans.append((first, last))
    return low, high


def _union(spans: Spans) -> float:
    total, reach = 0.0, 0.0
    for first, last in sorted(spans):
        if last > reach:
            total += last - max(first, reach)
            reach = last
    return min(total, 1.0)


def outlines(task: Task) -> tuple[list[Point], list[Point]]:
    """Polygons inside and around the area to be seen; they differ only for a disc."""
    if task.kind == "area_search":
        return list(task.points), list(task.points)
    (n, e), r = task.points[0], task.extent_m
    if task.pattern in ("square", "sweep"):
        square = [(n - r, e - r), (n - r, e + r), (n + r, e + r), (n + r, e - r)]
        return square, square
    step = 2 * math.pi / ROUND

    def disc(reach: float) -> list[Point]:
        return [
            (n + reach * math.cos(k * step), e + reach * math.sin(k * step)) for k in range(ROUND)
        ]

    return disc(r), disc(r / math.cos(step / 2))


def area_m2(ring: Sequence[Point]) -> float:
    """Area of a simple polygon."""
    if len(ring) < 3:
        return 0.0
    (n, e), twice = ring[0], 0.0
    for p, q in pairwise(ring[1:]):
        twice += (p[0] - n) * (q[1] - e) - (p[1] - e) * (q[0] - n)
    return abs(twice) / 2


@dataclass
class AreaSeen:
    """Areas [m^2]: seen, not seen, and undecided with squares of `finest_m`."""

    seen: float = 0.0
    unseen: float = 0.0
    open: float = 0.0
    finest_m: float = 0.0


def area_seen(prints: Footprints, ring: Sequence[Point]) -> AreaSeen:
    """How much of a polygon was seen. The polygon is clipped along with the squares."""
    low = [min(p[k] for p in ring) for k in (0, 1)]
    span = max(max(p[k] for p in ring) - low[k] for k in (0, 1))
    levels = max(0, math.ceil(math.log2(max(span, FINEST_M) / FINEST_M)))
    side = FINEST_M * 2**levels
    found = AreaSeen(finest_m=FINEST_M)
    every = np.arange(len(prints))
    todo = [(low[0], low[1], side, list(ring), every)]
    squares = 0
    while todo:
        n, e, side, part, index = todo.pop()
        area = area_m2(part)
        if area == 0:
            continue
        squares += 1
        within, touched = _square(prints, index, n, e, side)
        if within:
            found.seen += area
        elif len(touched) == 0:
            found.unseen += area
        elif side <= FINEST_M or squares > MOST_SQUARES:
            found.open += area
            found.finest_m = max(found.finest_m, side)
        else:
            half = side / 2
            south, north = _cut(part, 0, n + half)
            for base, strip in ((n, south), (n + half, north)):
                west, east = _cut(strip, 1, e + half)
                todo.append((base, e, half, west, touched))
                todo.append((base, e + half, half, east, touched))
    return found


def _square(
    prints: Footprints, index: NDArray[np.intp], n: float, e: float, side: float
) -> tuple[bool, NDArray[np.intp]]:
    """Whether one footprint certainly contains the square, and which of them may touch it."""
    half = side / 2
    centre = np.array([n + half, e + half])
    normals = prints.normals[index]
    at = normals @ centre - prints.offsets[index]
    reach = half * np.abs(normals).sum(axis=2)
    if np.any(prints.sure[index] & (np.max(at + reach, axis=1) <= -ACCURACY_M)):
        return True, index
    box = prints.boxes[index]
    near = (box[:, 0] <= n + side) & (n <= box[:, 2]) & (box[:, 1] <= e + side) & (e <= box[:, 3])
    apart = prints.sure[index] & (np.max(at - reach, axis=1) > ACCURACY_M)
    return False, index[near & ~apart]


def _cut(ring: list[Point], axis: int, at: float) -> tuple[list[Point], list[Point]]:
    """A polygon split by a line along an axis; parts may be joined by edges of zero width."""
    less: list[Point] = []
    more: list[Point] = []
    for k, q in enumerate(ring):
        p = ring[k - 1]
        if (p[axis] < at < q[axis]) or (q[axis] < at < p[axis]):
            t = (at - p[axis]) / (q[axis] - p[axis])
            other = p[1 - axis] + t * (q[1 - axis] - p[1 - axis])
            middle = (at, other) if axis == 0 else (other, at)
            less.append(middle)
            more.append(middle)
        if q[axis] <= at:
            less.append(q)
        if q[axis] >= at:
            more.append(q)
    return less, more
