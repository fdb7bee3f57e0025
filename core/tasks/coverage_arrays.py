"""The squares of an area, and which of them footprints contain: loops over arrays.

The kernels are those of `core.geofence.planar` and `core.tasks.coverage_steps`, step by step as their folds run
them. CPython runs these functions directly; `core.readings.machine.compiled.machine` compiles the same text.
"""

import math

import numpy as np

from cratous.core.geofence.planar import (
    Seen,
    contact_step,
    location_result,
    location_step,
)
from cratous.core.kernel import Vec2, driver
from cratous.core.tasks.coverage_steps import within_step


def place_of(edges: np.ndarray, n: float, e: float) -> int:
    """The place of a point: 1 inside, 0 on the boundary, -1 outside. edges: (k, 4)."""
    seen, p = Seen(False, False), Vec2(n, e)
    for k in range(len(edges)):
        if min(edges[k, 1], edges[k, 3]) <= e and e <= max(edges[k, 1], edges[k, 3]):
            seen = location_step(
                seen, Vec2(edges[k, 0], edges[k, 1]), Vec2(edges[k, 2], edges[k, 3]), p
            )
    return location_result(seen)


@driver(checked_by=("location_step", "contact_step"))
def grid_squares(
    edges: np.ndarray, north: float, east: float, rows: int, columns: int, side: float,
    found: np.ndarray,
) -> int:  # fmt: skip
    """Fill `found` (rows * columns, 2) with the centres of the squares that share a point with a polygon.

    edges (k, 4): north, east, north, east of each edge; north, east: the grid's corner; side [m]. From south to
    north, and within a row from west to east. Returns their number.
    """
    half, count, m = side / 2, 0, len(edges)
    near = np.empty(m, np.int64)
    sides = np.empty((4, 4))
    for i in range(rows):
        x = north + (i + 0.5) * side
        known, inside = False, False
        for j in range(columns):
            y = east + (j + 0.5) * side
            close = 0
            for k in range(m):
                a, b, c, d = edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]
                beside = min(a, c) > x + half or max(a, c) < x - half
                if not (beside or min(b, d) > y + half or max(b, d) < y - half):
                    near[close] = k
                    close += 1
            if close == 0:
                # no edge comes near: the square has the place of its centre, and so have those beside it
                if not known:
                    known, inside = True, place_of(edges, x, y) >= 0
                shares = inside
            else:
                known, met = False, bool(0)  # no literal, as in `leg_zone`
                for s in range(4):
                    # corners in turn: south-west, south-east, north-east, north-west
                    p = Vec2(x + (half if s == 2 or s == 3 else -half),
                             y + (half if s == 1 or s == 2 else -half))  # fmt: skip
                    q = Vec2(x + (half if s == 1 or s == 2 else -half),
                             y + (half if s == 0 or s == 1 else -half))  # fmt: skip
                    sides[s, 0], sides[s, 1], sides[s, 2], sides[s, 3] = p.x, p.y, q.x, q.y
                    for k in range(close):
                        e = edges[near[k]]
                        met = contact_step(met, Vec2(e[0], e[1]), Vec2(e[2], e[3]), p, q)
                shares = met or place_of(edges, x, y) >= 0
                if not shares:
                    for k in range(close):
                        e = edges[near[k]]
                        shares = shares or place_of(sides, e[0], e[1]) >= 0
            if shares:
                found[count, 0], found[count, 1] = x, y
                count += 1
    return count


def first_from(centres: np.ndarray, low: int, north: float, east: float) -> int:
    """The first square from `low` on that lies in the row of `north` and not west of `east`, or in a row north of it.

    centres (n, 2): from south to north, and within a row from west to east.
    """
    high = len(centres)
    while low < high:
        middle = (low + high) // 2
        if centres[middle, 0] < north or (
            centres[middle, 0] == north and centres[middle, 1] < east
        ):
            low = middle + 1
        else:
            high = middle
    return low


@driver(checked_by=("within_step",))
def mark_seen(centres: np.ndarray, half: float, quads: np.ndarray, seen: np.ndarray) -> None:
    """Set `seen` (n, bool) for every square of which each point lies in one of the convex footprints.

    centres (n, 2): from south to north, and within a row from west to east; half: of a square's side [m]; quads
    (m, k, 2): corners of footprints, counter-clockwise (north to east), without NaN. Bounding boxes only skip squares.
    """
    total = len(centres)
    for f in range(len(quads)):
        quad = quads[f]
        low_n, high_n, low_e, high_e = quad[0, 0], quad[0, 0], quad[0, 1], quad[0, 1]
        for j in range(1, len(quad)):
            low_n, high_n = min(low_n, quad[j, 0]), max(high_n, quad[j, 0])
            low_e, high_e = min(low_e, quad[j, 1]), max(high_e, quad[j, 1])
        south, north, west, east = low_n + half, high_n - half, low_e + half, high_e - half
        k = first_from(centres, 0, south, west)
        while k < total and centres[k, 0] <= north:
            n, e = centres[k, 0], centres[k, 1]
            if e < west:
                k = first_from(centres, k + 1, n, west)
            elif e > east:
                k = first_from(centres, k + 1, n, math.inf)
            else:
                if not seen[k]:
                    within, centre = bool(1), Vec2(n, e)
                    for j in range(len(quad)):
                        b = j + 1 if j + 1 < len(quad) else 0
                        p, q = Vec2(quad[j, 0], quad[j, 1]), Vec2(quad[b, 0], quad[b, 1])
                        within = within_step(within, p, q, centre, half)
                    seen[k] = within
                k += 1
