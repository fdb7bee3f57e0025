"""How much of an area footprints have covered: the area is cut into squares, small ones.

A square counts as seen only if ONE convex footprint contains all of it, so the share that is
reported is never more than what was seen; squares that straddle the outline count in full against
the flight. A convex polygon in counter-clockwise order (x to y) is what lies left of all its
edges: `square_within` says that of every point of a square (definition: `spec.geofence`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from cratous.core.kernel import Vec2, driver, fold, kernel
from cratous.core.polygon import edges_of, locate, meets_boundary, orient
from cratous.spec.mission import Pattern, Task

Corner = tuple[float, float]
FINEST_M = 10.0
"""Squares are this large, or larger where there would be more than MOST."""
MOST = 1_000_000
ROUND = 64
"""Corners of the polygon around a disc."""


@kernel(implements="geofence.square_point_left_of")
def square_left_of(a: Vec2, b: Vec2, centre: Vec2, half: float) -> bool:
    """True iff every point of the square lies left of the line a-b, or on it.

    centre, half: the square's middle and half of its side [m], >= 0; sides along the axes.
    """
    return orient(a, b, centre) >= half * (abs(b.x - a.x) + abs(b.y - a.y))


@kernel(implements="geofence.every_step")
def within_step(so_far: bool, a: Vec2, b: Vec2, centre: Vec2, half: float) -> bool:
    """Add the edge a-b to whether the square is left of all edges."""
    return so_far and square_left_of(a, b, centre, half)


@kernel(implements="geofence.every_result")
def within_result(so_far: bool) -> bool:
    """Whether the square is left of all edges."""
    return so_far


square_within = fold(
    name="square_within",
    implements="geofence.square_point_left_of",
    step=within_step,
    start=True,
    finish=within_result,
)


def disc(centre: Corner, radius_m: float) -> tuple[Corner, ...]:
    """A polygon around a disc: its sides touch the circle."""
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
    """The side of the squares into which an area is cut [m]."""
    return max(FINEST_M, math.sqrt(area_m2(vertices) / most))


@driver(checked_by=("locate", "meets_boundary"))
def squares(vertices: Sequence[Corner], side_m: float) -> list[Corner]:
    """Centres, from south to north, of all squares of a grid that share a point with the polygon."""
    edges = edges_of(vertices)
    norths, easts = [p[0] for p in vertices], [p[1] for p in vertices]
    half, found = side_m / 2, []
    for i in range(max(1, math.ceil((max(norths) - min(norths)) / side_m))):
        x = min(norths) + (i + 0.5) * side_m
        row = [e for e in edges if _reaches(e[0].x, e[1].x, x - half, x + half)]
        inside: bool | None = None
        for j in range(max(1, math.ceil((max(easts) - min(easts)) / side_m))):
            y = min(easts) + (j + 0.5) * side_m
            near = [e for e in row if _reaches(e[0].y, e[1].y, y - half, y + half)]
            if near:
                inside = None
                if _shares_a_point(x, y, half, near, edges):
                    found.append((x, y))
                continue
            # no edge comes near: the square is where its middle is, and so are those beside it
            if inside is None:
                beside = [e for e in edges if _reaches(e[0].y, e[1].y, y, y)]
                inside = locate(beside, Vec2(x, y)) >= 0
            if inside:
                found.append((x, y))
    return found


def _reaches(one: float, other: float, low: float, high: float) -> bool:
    return min(one, other) <= high and max(one, other) >= low


def _shares_a_point(x: float, y: float, half: float, near: Sequence[Any], edges: Any) -> bool:
    """A square with an edge of the polygon near it has a point in common with the polygon."""
    a, b = Vec2(x - half, y - half), Vec2(x - half, y + half)
    c, d = Vec2(x + half, y + half), Vec2(x + half, y - half)
    sides = ((a, b), (b, c), (c, d), (d, a))
    if any(meets_boundary(near, p, q) for p, q in sides):
        return True
    return locate(edges, Vec2(x, y)) >= 0 or any(locate(sides, e[0]) >= 0 for e in near)


def _counter_clockwise(footprint: Sequence[Corner]) -> tuple[Corner, ...]:
    return tuple(footprint) if _doubled(footprint) >= 0 else tuple(footprint)[::-1]


def perhaps_seen(centres: Any, side_m: float, footprint: Sequence[Corner]) -> Any:
    """Indices of the squares that seem to lie in a convex footprint, in plain floats.

    centres: array of shape (n, 2), from south to north. For planning, and to leave squares out before the kernel.
    """
    import numpy as np

    corners, half = _counter_clockwise(footprint), side_m / 2
    low, high = np.min(corners, axis=0) + half, np.max(corners, axis=0) - half
    first, last = (
        np.searchsorted(centres[:, 0], low[0]),
        np.searchsorted(centres[:, 0], high[0], "right"),
    )
    easts = centres[first:last, 1]
    maybe = first + ((easts >= low[1]) & (easts <= high[1])).nonzero()[0]
    for a, b in edges_of(corners):
        if len(maybe) == 0:
            break
        x, y = centres[maybe, 0] - a.x, centres[maybe, 1] - a.y
        dx, dy = b.x - a.x, b.y - a.y
        maybe = maybe[dx * y - dy * x >= half * (abs(dx) + abs(dy))]
    return maybe


@driver(checked_by=("square_within",))
def seen_squares(centres: Any, side_m: float, footprint: Sequence[Corner]) -> list[int]:
    """Indices of the squares of which every point lies in a convex footprint.

    centres: array of shape (n, 2), from south to north. The array pass only leaves out squares; each that it lets
    through is decided by the kernel.
    """
    edges, half = edges_of(_counter_clockwise(footprint)), side_m / 2
    return [
        int(k)
        for k in perhaps_seen(centres, side_m, footprint)
        if square_within(edges, Vec2(float(centres[k, 0]), float(centres[k, 1])), half)
    ]


def share_covered(unseen: int, side_m: float, whole_m2: float) -> float:
    """At least this share of an area has been seen, with so many squares unseen."""
    return max(0.0, 1 - unseen * side_m * side_m / whole_m2)
