"""A route through the points of another planner: made flyable, and each leg checked by the proved kernels."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from cratous.core.geofence.distance import FARTHER, edge_against
from cratous.core.kernel import Vec2
from cratous.core.routing.visibility import Roadmap, Route, route
from cratous.services.planning.spacing import TOLERANCE, near, spaced
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

NEAR_M = 50.0
"""A point this close to an end of the route counts as that end [m]."""
APART = 2.0
"""Spacing to which points are thinned out where the path stays the same, in turn radii."""
LEVEL_M = 1.0
"""Tolerance of altitudes above or below both ends [m]."""

Heading = Callable[[float, float], float]
_HEADINGS: tuple[Heading, ...] = (
    lambda a, b: a + ((b - a + math.pi) % (2 * math.pi) - math.pi) / 2,
    lambda a, b: a,
    lambda a, b: b,
)
"""Heading at a point: halfway between its legs, along the leg to it, or along the leg from it."""


class Flown(NamedTuple):
    """Flight performance: turn radius [m], steepest climb (metres per metre flown)."""

    radius_m: float
    slope: float


def inner(start: Pose, end: Pose, points: Sequence[Position]) -> tuple[list[Position], str]:
    """The points between start and end, and why they do not form a route between these; "" if they do."""
    a, b = Position(*start[:3]), Position(*end[:3])
    if not points:
        return [], "it has no places"
    for k, point in enumerate(points):
        if not all(math.isfinite(x) for x in point):
            return [], f"place {k + 1} is too far away to be told where"
        low, high, level = (Vec2(p.alt_m, 0.0) for p in (a, b, point))
        if edge_against(level, low, high, LEVEL_M) == FARTHER:
            return [], f"place {k + 1} is at {point.alt_m:.0f} m, above or below both ends"
    if not near(points[-1], b, NEAR_M):
        return [], "it does not end where it was asked to"
    first = 1 if near(points[0], a, NEAR_M) else 0
    return list(points[first:-1]), ""


def joined(
    start: Pose, end: Pose, vias: Sequence[Position], flown: Flown, zones: tuple[Zone, ...]
) -> Route:
    """The flyable route through these points, in order, that keeps the zones; or none and the reason."""
    places = [Position(*start[:3]), *_climbing(start, end, vias), Position(*end[:3])]
    off_m = TOLERANCE * flown.radius_m
    places = list(spaced(places, APART * flown.radius_m, off_m, zones))
    found = Route((), 0.0, "")
    for heading in _HEADINGS:
        found = _links(_poses(start, end, places, heading), flown, Roadmap(zones))
        if found.points:
            return found
    return found


def _links(poses: Sequence[Pose], flown: Flown, roadmap: Roadmap) -> Route:
    """From pose to pose, each by the shortest route that the zones allow."""
    path, metres = [Position(*poses[0][:3])], 0.0
    for k in range(1, len(poses)):
        link = route(poses[k - 1], poses[k], flown.radius_m, roadmap, flown.slope)
        if not link.points:
            return Route((), 0.0, f"leg {k} of it: {link.reason}")
        path, metres = [*path, *link.points[1:]], metres + link.length_m
    return Route(tuple(path), metres)


def _poses(start: Pose, end: Pose, places: Sequence[Position], heading: Heading) -> list[Pose]:
    made = [start]
    for k in range(1, len(places) - 1):
        p, here, q = places[k - 1 : k + 2]
        made.append(Pose(*here, heading(_bearing(p, here), _bearing(here, q))))
    return [*made, end]


def _climbing(start: Pose, end: Pose, vias: Sequence[Position]) -> list[Position]:
    """The points with the climb spread evenly along the path."""
    places = [Position(*start[:3]), *vias, Position(*end[:3])]
    run = [0.0]
    for k in range(1, len(places)):
        p, q = places[k - 1], places[k]
        run.append(run[-1] + math.hypot(q.north_m - p.north_m, q.east_m - p.east_m))
    rise = (end.alt_m - start.alt_m) / (run[-1] or 1.0)
    return [p._replace(alt_m=start.alt_m + rise * s) for p, s in zip(places, run, strict=True)][
        1:-1
    ]


def _bearing(p: Position, q: Position) -> float:
    return math.atan2(q.east_m - p.east_m, q.north_m - p.north_m)
