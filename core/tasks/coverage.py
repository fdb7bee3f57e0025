"""How much of an area footprints have covered: the area is divided into small squares.

A square counts as seen only if ONE convex footprint contains all of it, so the reported share is never more than what
was seen; an unseen square that straddles the outline counts in full as unseen. A convex polygon in counter-clockwise
order (x to y) is what lies left of all its edges: `square_within` tests that for every point of a square. The loops:
`core.tasks.coverage_arrays`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from cratous.core.geofence.planar import orient
from cratous.core.kernel import Vec2
from cratous.core.readings.tiered import swift
from cratous.core.tasks.coverage_arrays import grid_squares, mark_seen
from cratous.spec.mission import Pattern, Task

Corner = tuple[float, float]
FINEST_M = 10.0
"""Smallest side of the squares; larger if there would be more than MOST."""
MOST = 1_000_000
ROUND = 64
"""Corners of the polygon around a disc."""


def disc(centre: Corner, radius_m: float) -> tuple[Corner, ...]:
    """A polygon circumscribed about a disc: its sides touch the circle."""
    reach, step = radius_m / math.cos(math.pi / ROUND), 2 * math.pi / ROUND
    return tuple(
        (centre[0] + reach * math.cos(k * step), centre[1] + reach * math.sin(k * step))
        for k in range(ROUND)
    )


def outline(task: Task) -> tuple[Corner, ...]:
    """The polygon that an area or pattern search has to see."""
    if task.pattern is None:
        return tuple((p.north_m, p.east_m) for p in task.points)
    north, east, _ = task.points[0]
    r = task.extent_m
    if task.pattern in (Pattern.SPIRAL, Pattern.SECTOR):
        return disc((north, east), r)
    return tuple((north + x * r, east + y * r) for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1)))


def area_m2(vertices: Sequence[Corner]) -> float:
    """Area of a simple polygon, positive [m^2]."""
    return abs(_doubled(vertices)) / 2


def _doubled(vertices: Sequence[Corner]) -> float:
    """Twice the signed area, taken about a vertex so that far frames lose no digits."""
    o, rest = Vec2(*vertices[0]), [Vec2(*vertex) for vertex in vertices[1:]]
    return sum(orient(o, p, q) for p, q in pairwise(rest))


def square_side_m(vertices: Sequence[Corner], most: int = MOST) -> float:
    """The side of the squares into which an area is divided [m]."""
    return max(FINEST_M, math.sqrt(area_m2(vertices) / most))


def squares(vertices: Sequence[Corner], side_m: float) -> list[Corner]:
    """Centres, from south to north, of all squares of a grid that share a point with the polygon."""
    found = square_array(tuple((float(n), float(e)) for n, e in vertices), float(side_m))
    return [(n, e) for n, e in found.tolist()]


def square_array(vertices: tuple[Corner, ...], side_m: float) -> Any:
    """The result of `squares` as an array (n, 2)."""
    import numpy as np

    corners = np.array(vertices, float)
    low, high = corners.min(axis=0), corners.max(axis=0)
    rows, columns = (max(1, math.ceil(gap / side_m)) for gap in (high - low).tolist())
    found = np.empty((rows * columns, 2))
    edges = np.ascontiguousarray(np.hstack([corners, np.roll(corners, -1, axis=0)]))
    count = swift(grid_squares, rows * columns // 4)(
        edges, float(low[0]), float(low[1]), rows, columns, side_m, found
    )
    return found[:count].copy()


def look(centres: Any, side_m: float, footprints: Any, seen: Any) -> None:
    """Set `seen` (n, bool) for the squares of which every point lies in one of the footprints.

    centres (n, 2): as from `square_array`; footprints (m, k, 2): convex, either orientation; one with
    NaN sees nothing.
    """
    import numpy as np

    quads = np.asarray(footprints, float)
    quads = quads[~np.isnan(quads).any(axis=(1, 2))]
    ahead = np.roll(quads, -1, axis=1) - quads[:, :1]
    behind = quads - quads[:, :1]
    twice = (behind[..., 0] * ahead[..., 1] - behind[..., 1] * ahead[..., 0]).sum(axis=1)
    quads = np.ascontiguousarray(np.where(twice[:, None, None] < 0, quads[:, ::-1], quads))
    work = 1 + len(centres) * len(quads) // 300
    swift(mark_seen, work)(np.ascontiguousarray(centres), float(side_m) / 2, quads, seen)


def seen_squares(centres: Any, side_m: float, footprint: Sequence[Corner]) -> list[int]:
    """Indices of the squares of which every point lies in a convex footprint, as `look` says."""
    import numpy as np

    seen = np.zeros(len(centres), np.bool_)
    look(centres, side_m, [footprint], seen)
    return [int(k) for k in seen.nonzero()[0]]


def share_covered(unseen: int, side_m: float, whole_m2: float) -> float:
    """Lower bound of the share of an area that has been seen, given the number of unseen squares."""
    return max(0.0, 1 - unseen * side_m * side_m / whole_m2)
