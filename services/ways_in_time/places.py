"""The places over which a way in time is searched: beside zones, beside and behind traffic, and some of neither.

The goal comes first. The samples are the same for the same question.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence

from cratous.core.avoidance.prediction import Intruder, later
from cratous.core.ways_in_time.scene import Scene
from cratous.spec.mission import Position, Zone, ZoneKind

MOST_PLACES = 90
"""As many places are used; those that lengthen the way least."""
RINGS = (0.5, 1.5)
"""Distances of places from zones, in turn radii beyond the margin."""
SHARES = (0.25, 0.5, 0.75)
"""Places on the straight line to the goal, by their share of it."""
SAMPLES = 24
"""Number of samples around that line."""
ASIDE, ASIDE_RADII = 8, 3.0
"""Number of places around the start, and their distance in turn radii."""
AWAY_M = 2.0
"""Distance of the nearest places beyond the margin and the radius [m]."""


def places_of(
    start: Position,
    goal: Position,
    speed_m_s: float,
    radius_m: float,
    scene: Scene,
    layers_m: Sequence[float] = (),
) -> tuple[Position, ...]:
    """The goal, then places between it and the start.

    speed_m_s, radius_m: of the flight and of its turns; layers_m: altitudes beside those of start and goal [m].
    """
    zones, intruders = scene.zones, scene.intruders
    keep_m = max([scene.volume.dthr_m, *(v.dthr_m for v in scene.volumes)])
    found = dict[Position, float]()
    levels = tuple(dict.fromkeys((start.alt_m, goal.alt_m, *layers_m)))
    beside = [scene.margin_m + AWAY_M + share * radius_m for share in RINGS]
    around = [2 * math.pi * k / ASIDE for k in range(ASIDE)]
    away_m = ASIDE_RADII * radius_m
    flat = [
        (start.north_m + away_m * math.cos(a), start.east_m + away_m * math.sin(a)) for a in around
    ]
    first = [
        Position(*place, alt) for place in flat for alt in dict.fromkeys((start.alt_m, goal.alt_m))
    ]
    flat = [*_beside_zones(zones, beside)]
    flat += _beside_traffic(start, goal, speed_m_s, intruders, keep_m + AWAY_M + radius_m)
    flat += _between(start, goal, radius_m)
    for north, east in _outside(flat, zones):
        for alt in levels:
            place = Position(north, east, alt)
            found[place] = _detour_m(start, place, goal)
    ordered = sorted(found, key=lambda place: (found[place], place))
    return tuple(dict.fromkeys((goal, *first, *ordered)))[:MOST_PLACES]


def _detour_m(start: Position, place: Position, goal: Position) -> float:
    """Length of the way over a place [m]."""
    return math.dist(start, place) + math.dist(place, goal)


def _beside_zones(
    zones: Sequence[Zone], distances_m: Sequence[float]
) -> Iterator[tuple[float, float]]:
    """Corners of the outlines of the zones offset by the distances: outside keep-outs, inside keep-ins."""
    if not zones:
        return
    from shapely import MultiPolygon, Polygon

    for zone in zones:
        for distance in distances_m:
            outward = distance if zone.kind is ZoneKind.KEEP_OUT else -distance
            shape = Polygon(zone.vertices).buffer(outward, join_style="mitre", mitre_limit=2.0)
            for part in shape.geoms if isinstance(shape, MultiPolygon) else (shape,):
                if not part.is_empty:
                    yield from ((float(x), float(y)) for x, y in part.exterior.coords[:-1])


def _outside(
    places: Sequence[tuple[float, float]], zones: Sequence[Zone]
) -> Iterator[tuple[float, float]]:
    """The places that are in no keep-out zone, about: they are of no use, whatever the kernels say of their legs."""
    if not zones:
        yield from places
        return
    from shapely import Polygon, contains_xy, union_all

    barred = union_all([Polygon(z.vertices) for z in zones if z.kind is ZoneKind.KEEP_OUT])
    within = contains_xy(barred, [p[0] for p in places], [p[1] for p in places])
    yield from (place for place, bad in zip(places, within, strict=True) if not bad)


def _beside_traffic(
    start: Position,
    goal: Position,
    speed_m_s: float,
    intruders: Sequence[Intruder],
    away_m: float,
) -> Iterator[tuple[float, float]]:
    """Right and left of each intruder, before it and behind it, as it is nearest to a straight flight to the goal."""
    whole = math.hypot(goal.north_m - start.north_m, goal.east_m - start.east_m)
    if whole == 0:
        return
    north, east = (goal.north_m - start.north_m) / whole, (goal.east_m - start.east_m) / whole
    for other in intruders:
        best_s, least = 0.0, math.inf
        for k in range(21):
            at_s = k / 20 * whole / speed_m_s
            there = later(other, at_s).position
            far = math.hypot(
                start.north_m + north * speed_m_s * at_s - there.north_m,
                start.east_m + east * speed_m_s * at_s - there.east_m,
            )
            if far < least:
                best_s, least = at_s, far
        near = later(other, best_s)
        p, v = near.position, near.velocity
        fast = math.hypot(v.north_m_s, v.east_m_s)
        along_north, along_east = (
            (v.north_m_s / fast, v.east_m_s / fast) if fast > 0 else (north, east)
        )
        for a, b in (
            (along_north, along_east),
            (-along_north, -along_east),
            (-along_east, along_north),
            (along_east, -along_north),
        ):
            yield p.north_m + away_m * a, p.east_m + away_m * b


def _between(start: Position, goal: Position, radius_m: float) -> Iterator[tuple[float, float]]:
    """Places on the straight line, and samples around it."""
    for share in SHARES:
        yield (
            start.north_m + share * (goal.north_m - start.north_m),
            start.east_m + share * (goal.east_m - start.east_m),
        )
    around_m = 4 * radius_m
    low = [min(start[k], goal[k]) - around_m for k in (0, 1)]
    high = [max(start[k], goal[k]) + around_m for k in (0, 1)]
    draw = random.Random(SAMPLES)  # fixed seed: the same answer to the same question
    for _ in range(SAMPLES):
        yield draw.uniform(low[0], high[0]), draw.uniform(low[1], high[1])
