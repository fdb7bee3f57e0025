"""The flyable parts of a path cut by zones: those outside with room to turn, joined by routes around the
zones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import dubins, polyline_length_m
from cratous.core.routing.visibility import Roadmap, Route, circle, route
from cratous.core.tasks.sweep import Piece
from cratous.services.planning.smoothing import without_collinear
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

STEP_M = 20.0
"""A path is divided at this distance [m]; a part ends at most this much early."""
BEGINNINGS = 4
"""Number of parts tried as the first one if not all can be reached from it."""


class Cut(NamedTuple):
    """The flown parts as one path, and the zones that cut it. No points: nothing can be flown."""

    points: tuple[Position, ...]
    zones: tuple[Zone, ...]

    @property
    def start(self) -> Pose:
        """Pose at the beginning of the path."""
        return _pose(self.points[0], self.points[1], at_end=False)

    @property
    def end(self) -> Pose:
        """Pose at the end of the path."""
        return _pose(self.points[-2], self.points[-1], at_end=True)


def cut(
    paths: Sequence[Sequence[Position]],
    radius_m: float,
    roadmaps: Sequence[Roadmap],
    in_order: bool,
) -> Cut:
    """The flyable parts of paths that zones cut, in order, or always the nearest next. Parts without a route
    to them are left out.

    radius_m: turn radius [m].
    """
    zones = roadmaps[0].zones
    pieces, cutting = list[Piece](), dict[int, Zone]()
    for path in paths:
        free, broken = _free(path, radius_m, zones)
        pieces += free
        cutting.update((zone.id, zone) for zone in broken)
    best: tuple[list[Piece], tuple[Position, ...]] = [], ()
    for first in range(min(BEGINNINGS, len(pieces))):
        made = _joined(pieces, first, radius_m, roadmaps, in_order)
        if _length_m(made[0]) > _length_m(best[0]):
            best = made
        if len(best[0]) == len(pieces):
            break
    points = without_collinear(list(best[1])) if best[1] else ()
    return Cut(points, tuple(cutting[number] for number in sorted(cutting)))


def _length_m(pieces: Sequence[Piece]) -> float:
    return sum(polyline_length_m(piece.points) for piece in pieces)


def _joined(
    pieces: Sequence[Piece],
    first: int,
    radius_m: float,
    roadmaps: Sequence[Roadmap],
    in_order: bool,
) -> tuple[list[Piece], tuple[Position, ...]]:
    """The pieces that can be reached one from the other, and the path along them."""
    kept, left = [pieces[first]], [piece for k, piece in enumerate(pieces) if k != first]
    points = list(pieces[first].points)
    while left:
        here = kept[-1].end
        nearest = min(
            left, key=lambda p: 0 if in_order else dubins(here, p.start, radius_m).length_m
        )
        left.remove(nearest)
        way = Route((), 0.0, "")
        for roadmap in roadmaps:
            way = route(here, nearest.start, radius_m, roadmap)
            if way.points:
                break
        if way.points:
            points += [*way.points[1:], *nearest.points[1:]]
            kept.append(nearest)
    return kept, tuple(points)


def _free(
    path: Sequence[Position], radius_m: float, zones: Sequence[Zone]
) -> tuple[list[Piece], list[Zone]]:
    """The parts of a path outside the zones, and the zones that cut it."""
    if first_bad_leg(path, zones) is None:
        whole = _with_room(list(path), radius_m, ())
        return ([whole] if whole else []), []
    fine, broken = _fine(path), list[Zone]()
    parts = [[fine[0]]]
    for p, q in pairwise(fine):
        bad = first_bad_leg((p, q), zones)
        if bad is None:
            parts[-1].append(q)
        else:
            broken.append(bad[1])
            parts.append([q])
    pieces = [_with_room(part, radius_m, zones) for part in parts]
    return [piece for piece in pieces if piece is not None], broken


def _fine(path: Sequence[Position]) -> list[Position]:
    """The path with points at most STEP_M apart."""
    found = [path[0]]
    for p, q in pairwise(path):
        count = max(1, math.ceil(math.hypot(q.north_m - p.north_m, q.east_m - p.east_m) / STEP_M))
        found += [
            Position(*(a + (b - a) * k / count for a, b in zip(p, q, strict=True)))
            for k in range(1, count)
        ]
        found.append(q)
    return found


def _with_room(points: list[Position], radius_m: float, zones: Sequence[Zone]) -> Piece | None:
    """The part between the outermost points at which a full turn keeps the zones; None if there is none."""
    kept = [p for k, p in enumerate(points) if k == 0 or p[:2] != points[k - 1][:2]]
    first, last = 0, len(kept) - 1
    while first < last and not _turns(
        _pose(kept[last - 1], kept[last], at_end=True), radius_m, zones
    ):
        last -= 1
    while first < last and not _turns(
        _pose(kept[first], kept[first + 1], at_end=False), radius_m, zones
    ):
        first += 1
    if first == last:
        return None
    part = kept[first : last + 1]
    start = _pose(part[0], part[1], at_end=False)
    end = _pose(part[-2], part[-1], at_end=True)
    return Piece(start, end, without_collinear(part))


def _turns(pose: Pose, radius_m: float, zones: Sequence[Zone]) -> bool:
    """Whether a full turn to either side keeps the zones."""
    return any(
        first_bad_leg(circle(pose, radius_m, clockwise), zones) is None
        for clockwise in (True, False)
    )


def _pose(a: Position, b: Position, at_end: bool) -> Pose:
    """The pose at the beginning or the end of a leg."""
    return Pose(*(b if at_end else a), math.atan2(b.east_m - a.east_m, b.north_m - a.north_m))
