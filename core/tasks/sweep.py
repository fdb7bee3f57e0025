"""Lanes over an area, and search patterns, as straight segments that are then joined by turns.

A *swath* is what a footprint covers beside and ahead of a moving aircraft; a *strip* is a straight part of the area
as wide as one lane covers. Lanes are made so that their swaths cover the strips. Nothing here is trusted: legs are
checked by the zone kernels, coverage by `core.tasks.coverage`.

Directions are clockwise from north; "right" of a heading h is the direction (-sin h, cos h).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

from cratous.core.kernel import driver
from cratous.core.routing.dubins import dubins, polyline_length_m
from cratous.core.routing.visibility import Roadmap, Route, route
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

Corner = tuple[float, float]
SLICES = 40
"""Number of positions across a footprint at which its length is measured."""
LANES_MOST = 200
"""Maximum number of lanes that one vehicle flies in one task."""


class Swath(NamedTuple):
    """From left_m to right_m beside the track, fully seen between near_m and far_m ahead [m]."""

    left_m: float
    right_m: float
    near_m: float
    far_m: float

    @property
    def width_m(self) -> float:
        """The width of the strip covered by one pass [m]."""
        return self.right_m - self.left_m


class Strip(NamedTuple):
    """The centre line of a strip that one lane has to cover, from one end to the other."""

    start: Corner
    end: Corner


class Piece(NamedTuple):
    """A part of a path that is flown unchanged: end poses and the polyline between."""

    start: Pose
    end: Pose
    points: tuple[Position, ...]


SwathOf = Callable[[float], Swath | None]
"""The swath when flying with a heading [rad]; None if the camera sees no ground."""


def swath(corners: Sequence[Corner], heading_rad: float, least_m: float) -> Swath | None:
    """The swath of a convex footprint given relative to the aircraft (north, east) [m].

    Only the part at least least_m long in the direction of flight counts, so that successive images leave no gaps.
    None if there is no such part.
    """
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    own = [(n * c + e * s, e * c - n * s) for n, e in corners]
    row = _rows(own)
    low, high = min(p[1] for p in own), max(p[1] for p in own)
    slices = [low + (high - low) * k / SLICES for k in range(1, SLICES)]
    middle = max(slices, key=lambda y: _length(row(y)))
    if _length(row(middle)) < least_m:
        return None
    # a convex footprint is long enough between two positions, found by bisection to a millimetre
    left, right = (_edge_of(row, middle, end, least_m) for end in (low, high))
    rows = [row(left + (right - left) * k / SLICES) for k in range(SLICES + 1)]
    return Swath(left, right, max(r[0] for r in rows), min(r[1] for r in rows))


Row = tuple[float, float]
RowAt = Callable[[float], Row]


def _rows(own: Sequence[Corner]) -> RowAt:
    """The range (ahead) of a convex polygon (ahead, right), by the offset to the right of the centre; (0, 0) beside
    it.
    """
    edges = [
        (min(y1, y2), max(y1, y2), x1, y1, x2 - x1, y2 - y1, x2)
        for (x1, y1), (x2, y2) in zip(own, (*own[1:], own[0]), strict=True)
    ]

    def row(y: float) -> Row:
        low, high = math.inf, -math.inf
        for least, most, x, begin, ahead, aside, last in edges:
            if not least <= y <= most:
                continue
            if aside:
                x = last = x + (y - begin) / aside * ahead
            if x > last:
                x, last = last, x
            if x < low:
                low = x
            if last > high:
                high = last
        return (low, high) if low <= high else (0.0, 0.0)

    return row


def _length(row: Row) -> float:
    return row[1] - row[0]


def _edge_of(row: RowAt, inner: float, outer: float, least_m: float) -> float:
    """The position nearest to `outer` at which the polygon is at least least_m long, as it is at `inner`."""
    while abs(outer - inner) > 1e-3:
        between = (inner + outer) / 2
        if _length(row(between)) >= least_m:
            inner = between
        else:
            outer = between
    return inner


def strips_needed(vertices: Sequence[Corner], heading_rad: float, width_m: float) -> int:
    """The number of parallel strips at most width_m wide that cover the polygon; 0 if more than LANES_MOST."""
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    across = [e * c - n * s for n, e in vertices]
    extent = max(across) - min(across)
    if extent > LANES_MOST * width_m * (1 + 1e-9):
        return 0
    return max(1, math.ceil(extent / width_m - 1e-9))


def strips(vertices: Sequence[Corner], heading_rad: float, width_m: float) -> list[Strip]:
    """The polygon divided into equal parallel strips at most width_m wide, from left to right.

    Each runs in the heading's direction over the whole extent of the polygon within it; empty if there would be more
    than LANES_MOST.
    """
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    own = [(n * c + e * s, e * c - n * s) for n, e in vertices]
    low, high = min(p[1] for p in own), max(p[1] for p in own)
    count = strips_needed(vertices, heading_rad, width_m)
    if count == 0:
        return []
    step, found = (high - low) / count, []
    for k in range(count):
        left, right = low + k * step, low + (k + 1) * step
        along = [x for x, y in own if left <= y <= right]
        for (x1, y1), (x2, y2) in zip(own, own[1:] + own[:1], strict=True):
            for y in (left, right):
                if min(y1, y2) < y < max(y1, y2):
                    along.append(x1 + (y - y1) / (y2 - y1) * (x2 - x1))
        if not along:
            continue
        middle = (left + right) / 2
        ends = [(x * c - middle * s, x * s + middle * c) for x in (min(along), max(along))]
        found.append(Strip(ends[0], ends[1]))
    return found


def lane(strip: Strip, heading_rad: float, seen: Swath, alt_m: float, lead_m: float) -> Piece:
    """The straight pass that covers a strip along a heading; lead_m: room to settle before it."""
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    (n1, e1), (n2, e2) = strip
    x1, x2 = sorted((n1 * c + e1 * s, n2 * c + e2 * s))
    y = (e1 * c - n1 * s) - (seen.left_m + seen.right_m) / 2
    first, last = x1 - seen.near_m - lead_m, x2 - seen.far_m + 0.2 * lead_m
    if last < first + lead_m:
        last = first + lead_m + 1.0
    poses = [Pose(x * c - y * s, x * s + y * c, alt_m, heading_rad) for x in (first, last)]
    return Piece(poses[0], poses[1], tuple(Position(*pose[:3]) for pose in poses))


def orders(count: int, stride: int) -> list[tuple[int, ...]]:
    """Possible orders of parallel lanes: neighbours in turn, or with a stride.

    With a turn wider than a lane, flying every k-th lane and then those between is shorter.
    """
    found = []
    for every in sorted({1, max(1, min(stride, count - 1))}):
        order: list[int] = []
        for first in range(every):
            column = list(range(first, count, every))
            order += column[::-1] if first % 2 else column
        found.append(tuple(order))
    return found


def sweep(
    parts: Sequence[Strip],
    heading_rad: float,
    swath_of: SwathOf,
    radius_m: float,
    alt_m: float,
    lead_m: float,
    from_right: bool,
) -> list[Piece]:
    """Lanes over parallel strips there and back, the first along the heading; shortest order."""
    seen = {h: swath_of(h) for h in (heading_rad, heading_rad + math.pi)}
    row = list(parts)[::-1] if from_right else list(parts)
    widest = math.dist(*_middles(row)) / (len(row) - 1) if len(row) > 1 else 2 * radius_m
    best: tuple[float, list[Piece]] | None = None
    for order in orders(len(row), math.ceil(2 * radius_m / max(widest, 1.0))):
        made = []
        for k, index in enumerate(order):
            heading = heading_rad + (math.pi if k % 2 else 0.0)
            swath_here = seen[heading]
            assert swath_here is not None
            made.append(lane(row[index], heading, swath_here, alt_m, lead_m))
        length = unjoined_m(made, radius_m)
        if best is None or length < best[0] - 1e-6:
            best = (length, made)
    assert best is not None
    return best[1]


def _middles(row: Sequence[Strip]) -> tuple[Corner, Corner]:
    """The positions of the first and the last strip, measured across the strips, as points (across, 0) [m]."""
    (n1, e1), (n2, e2) = row[0]
    length = math.dist(*row[0]) or 1.0
    c, s = (n2 - n1) / length, (e2 - e1) / length
    across = [(n * -s + e * c) for n, e in (row[0].start, row[-1].start)]
    return (across[0], 0.0), (across[1], 0.0)


def unjoined_m(pieces: Sequence[Piece], radius_m: float) -> float:
    """Length of the pieces with their turns, as if there were no zones [m]."""
    total = sum(polyline_length_m(piece.points) for piece in pieces)
    return total + sum(dubins(a.end, b.start, radius_m).length_m for a, b in pairwise(pieces))


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok"))
def joined(pieces: Sequence[Piece], radius_m: float, roadmaps: Sequence[Roadmap]) -> Route:
    """The segments joined by turns that obey the zones, or the reason why that is not possible."""
    points: list[Position] = list(pieces[0].points)
    for k, (before, after) in enumerate(pairwise(pieces)):
        turn = Route((), 0.0, "")
        for roadmap in roadmaps:
            turn = route(before.end, after.start, radius_m, roadmap)
            if turn.points:
                break
        if not turn.points:
            return Route((), 0.0, f"the turn after lane {k + 1}: {turn.reason}")
        points += turn.points[1:]
        points += after.points[1:]
    return Route(tuple(points), polyline_length_m(tuple(points)))


def edge_headings(vertices: Sequence[Corner], apart_rad: float) -> list[float]:
    """Directions of the polygon's edges in [0, pi), the longest edge's first, apart_rad or more apart."""
    edges = [(p, q) for p, q in zip(vertices, (*vertices[1:], vertices[0]), strict=True) if p != q]
    edges.sort(key=lambda edge: -math.dist(*edge))
    kept: list[float] = []
    for (n1, e1), (n2, e2) in edges:
        heading = math.atan2(e2 - e1, n2 - n1) % math.pi
        if all(abs(math.remainder(heading - h, math.pi)) >= apart_rad for h in kept):
            kept.append(heading)
    return kept


def square_spiral(
    centre: Corner, extent_m: float, width_m: float, heading_rad: float
) -> list[Strip]:
    """Strips from the centre outwards that cover a square of side 2 extent_m, each a quarter turn on.

    The sides of the square are along the heading and across it; empty if there would be more than LANES_MOST strips.
    """
    count = max(2, math.ceil(2 * extent_m / width_m - 1e-9))
    if 2 * count > LANES_MOST:
        return []
    w = 2 * extent_m / count
    c, s = math.cos(heading_rad), math.sin(heading_rad)
    # in units of w, along and right of the heading; an even number of cells has no middle one
    x = y = 0.0 if count % 2 else -0.5
    dx, dy, found = 1, 0, []
    for k in range(2 * count - 1):
        cells = min(k // 2 + 1, count - 1)
        to = (x + dx * cells, y + dy * cells)
        ends = ((x - dx / 2, y - dy / 2), (to[0] + dx / 2, to[1] + dy / 2))
        start, end = (
            (centre[0] + w * (a * c - b * s), centre[1] + w * (a * s + b * c)) for a, b in ends
        )
        found.append(Strip(start, end))
        x, y = to
        dx, dy = -dy, dx
    return found


def sector(centre: Corner, extent_m: float, width_m: float, heading_rad: float) -> list[Strip]:
    """Passes over the centre from rim to rim, rotated so that neighbours meet at the rim; 3 or more."""
    count = 3
    if width_m < 2 * extent_m:
        count = max(3, math.ceil(math.pi / (2 * math.asin(width_m / (2 * extent_m))) - 1e-9))
    if count > LANES_MOST:
        return []
    found, heading = [], heading_rad
    for _ in range(count):
        n, e = extent_m * math.cos(heading), extent_m * math.sin(heading)
        found.append(Strip((centre[0] - n, centre[1] - e), (centre[0] + n, centre[1] + e)))
        heading += math.pi + math.pi / count
    return found


def along(parts: Sequence[Strip], swath_of: SwathOf, alt_m: float, lead_m: float) -> list[Piece]:
    """A lane over each strip in turn, from its start to its end."""
    made = []
    for part in parts:
        (n1, e1), (n2, e2) = part
        heading = math.atan2(e2 - e1, n2 - n1)
        seen = swath_of(heading)
        assert seen is not None
        made.append(lane(part, heading, seen, alt_m, lead_m))
    return made


def spiral(
    centre: Corner,
    first_m: float,
    last_m: float,
    step_m: float,
    heading_rad: float,
    clockwise: bool,
    alt_m: float,
) -> Piece:
    """A circle at first_m, then outwards by at most step_m per lap, and a circle at last_m."""
    laps = max(1, math.ceil((last_m - first_m) / step_m - 1e-9)) if last_m > first_m else 0
    side, points, poses = (1 if clockwise else -1), [], []
    whole = 2 + laps if laps else 1
    # chords that deviate from the curve by half a metre at most
    count = math.ceil(whole * 2 * math.pi / (2 * math.acos(1 - 0.5 / last_m)))
    for k in range(count + 1):
        turned = whole * 2 * math.pi * k / count
        share = min(max((turned / (2 * math.pi) - 1) / laps, 0.0), 1.0) if laps else 0.0
        r = first_m + share * (last_m - first_m)
        at = heading_rad + side * turned
        points.append(Position(centre[0] + r * math.cos(at), centre[1] + r * math.sin(at), alt_m))
        poses.append(at + side * math.pi / 2)
    return Piece(Pose(*points[0], poses[0]), Pose(*points[-1], poses[-1]), tuple(points))
