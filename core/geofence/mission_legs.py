"""Whether flown legs obey the zones: the proved polygon kernels, applied to mission data.

Zones must already have their padding turned into vertices; a zone that still has padding is refused, because a check
without it would be too weak.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import lru_cache

from cratous.core.geofence.mission_leg_arrays import as_points, first_bad, table
from cratous.core.geofence.planar import (
    edges_of,
    keep_in_leg_ok,
    keep_out_leg_ok,
    locate,
    meets_boundary,
)
from cratous.core.kernel import Vec2, driver
from cratous.core.readings.tiered import swift
from cratous.spec.mission import Position, Zone, ZoneKind

LONG = 8
Edge = tuple[Vec2, Vec2]
Box = tuple[float, float, float, float]


def _box(points: Sequence[tuple[float, float]]) -> Box:
    """Lowest and highest north, lowest and highest east."""
    norths, easts = [p[0] for p in points], [p[1] for p in points]
    return min(norths), max(norths), min(easts), max(easts)


@lru_cache(maxsize=512)
def _shape(
    vertices: tuple[tuple[float, float], ...], number: str
) -> tuple[Box, tuple[tuple[Box, Edge], ...]]:
    """The bounding box of a polygon, and its edges with theirs.

    number: type name of the coordinates, so that floats and equal rationals are cached separately.
    """
    return _box(vertices), tuple((_box(edge), edge) for edge in edges_of(vertices))


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "meets_boundary"))
def leg_ok(p: Position, q: Position, zone: Zone) -> bool:
    """True iff the straight leg from p to q obeys the zone. ValueError if the zone has padding.

    Bounding boxes only skip steps that change nothing in the folds: all edges if the leg's box does not touch the
    zone's, edges beside the ray from p, edges whose box does not touch the leg's.
    """
    if zone.padding_m != 0:
        raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
    whole, edges = _shape(zone.vertices, type(zone.vertices[0][0]).__name__)
    low, high = (p.alt_m, q.alt_m) if p.alt_m <= q.alt_m else (q.alt_m, p.alt_m)
    south, north = (p.north_m, q.north_m) if p.north_m <= q.north_m else (q.north_m, p.north_m)
    west, east = (p.east_m, q.east_m) if p.east_m <= q.east_m else (q.east_m, p.east_m)
    holds = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    if north < whole[0] or south > whole[1] or east < whole[2] or west > whole[3]:
        return holds(-1, False, low, high, zone.floor_m, zone.ceiling_m)
    a, b = Vec2(p.north_m, p.east_m), Vec2(q.north_m, q.east_m)
    beside = [edge for box, edge in edges if box[2] <= a.y <= box[3]]
    near = [
        edge
        for box, edge in edges
        if box[0] <= north and box[1] >= south and box[2] <= east and box[3] >= west
    ]
    where, meets = locate(beside, a), meets_boundary(near, a, b)
    return holds(where, meets, low, high, zone.floor_m, zone.ceiling_m)


def first_bad_leg(path: Sequence[Position], zones: Sequence[Zone]) -> tuple[int, Zone] | None:
    """Index of the first leg (path[i], path[i + 1]) that breaks a zone, and the zone; else None.

    A path of one point is a leg from that point to itself. A long path of plain numbers is checked by the same
    kernels in one call (`core.geofence.mission_leg_arrays`).
    """
    if len(path) > LONG and all(type(v) is float for p in path for v in p):
        k, z = swift(first_bad, len(path) // LONG)(as_points(path), table(tuple(zones)))
        return None if z < 0 else (int(k), zones[z])
    legs = [(path[0], path[0])] if len(path) == 1 else list(itertools.pairwise(path))
    for index, (p, q) in enumerate(legs):
        for zone in zones:
            if not leg_ok(p, q, zone):
                return index, zone
    return None
