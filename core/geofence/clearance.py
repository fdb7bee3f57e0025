"""Whether a straight leg, and every flight within a margin of it, obeys a zone.

Proved kernels decide where the leg begins, whether it comes within the margin, and what follows.
"""

from __future__ import annotations

from functools import lru_cache

from cratous.core.geofence.distance import comes_within
from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.geofence.planar import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2, driver
from cratous.spec.mission import Position, Zone, ZoneKind

Edge = tuple[Vec2, Vec2]
Box = tuple[float, float, float, float]


@lru_cache(maxsize=512)
def _shape(vertices: tuple[tuple[float, float], ...], number: str) -> tuple[Box, tuple[Edge, ...]]:
    """Lowest and highest north, lowest and highest east of a polygon, and its edges.

    number: type name of the coordinates, so that floats and equal rationals are cached separately.
    """
    norths, easts = [v[0] for v in vertices], [v[1] for v in vertices]
    return (min(norths), max(norths), min(easts), max(easts)), edges_of(vertices)


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "comes_within"))
def leg_keeps(p: Position, q: Position, zone: Zone, margin_m: float, rise_m: float = 0.0) -> bool:
    """True iff the straight leg from p to q obeys the zone and, from floor to ceiling, is farther than the margin
    from its boundary. ValueError if the zone has padding.

    margin_m: horizontal margin [m], >= 0; rise_m: vertical deviation of the flight from the leg [m], >= 0. Bounding
    boxes only skip steps that change nothing in the folds: a zone or an edge that is farther than the margin from the
    leg in one direction, and edges beside the ray from p.
    """
    if margin_m == 0 and rise_m == 0:
        return leg_ok(p, q, zone)
    if zone.padding_m != 0:
        raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
    low, high = min(p.alt_m, q.alt_m) - rise_m, max(p.alt_m, q.alt_m) + rise_m
    south, north = min(p.north_m, q.north_m) - margin_m, max(p.north_m, q.north_m) + margin_m
    west, east = min(p.east_m, q.east_m) - margin_m, max(p.east_m, q.east_m) + margin_m
    holds = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    whole, edges = _shape(zone.vertices, type(zone.vertices[0][0]).__name__)
    if north < whole[0] or south > whole[1] or east < whole[2] or west > whole[3]:
        return holds(-1, False, low, high, zone.floor_m, zone.ceiling_m)
    a, b = Vec2(p.north_m, p.east_m), Vec2(q.north_m, q.east_m)
    beside = [(c, d) for c, d in edges if min(c.y, d.y) <= a.y <= max(c.y, d.y)]
    near = [
        (c, d)
        for c, d in edges
        if min(c.x, d.x) <= north
        and max(c.x, d.x) >= south
        and min(c.y, d.y) <= east
        and max(c.y, d.y) >= west
    ]
    where, meets = locate(beside, a), comes_within(near, a, b, margin_m)
    return holds(where, meets, low, high, zone.floor_m, zone.ceiling_m)
