"""Zones as the planner uses them: with a tracking margin, and rings of via points around them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cratous.core.routing.visibility import Roadmap
from cratous.services.loading.polygons import hard_zones, padded
from cratous.spec.errors import BadInput
from cratous.spec.mission import Zone, ZoneKind

MARGIN_M = 20.0
"""Distance that routes keep from zones where there is room, as a margin for tracking errors [m]."""
RINGS = (0.15, 0.6, 1.2, 2.5)
"""Distances of the rings of via points from the zones, in turn radii."""


def roadmaps(zones: Sequence[Zone], radius_m: float) -> tuple[Roadmap, ...]:
    """Roadmaps to try in order: with the tracking margin, then without."""
    hard = hard_zones(zones)
    if not hard:
        return (Roadmap(()),)
    made = []
    for margin in (MARGIN_M, 0.0):
        wide = tuple(_widened(zone, margin) for zone in hard)
        rings = tuple(_ring(wide, 2.0 + share * radius_m) for share in RINGS)
        made.append(Roadmap(wide, rings))
    return tuple(made)


def _widened(zone: Zone, by_m: float) -> Zone:
    if by_m == 0:
        return zone
    try:
        return padded(replace(zone, padding_m=by_m), "", f"zone {zone.id}")
    except BadInput:
        return zone


def _ring(zones: Sequence[Zone], distance_m: float) -> tuple[tuple[float, float], ...]:
    """Corners of the zones' offset outlines: outside keep-outs, inside keep-ins."""
    from shapely import MultiPolygon, Polygon

    points: list[tuple[float, float]] = []
    for zone in zones:
        outward = distance_m if zone.kind is ZoneKind.KEEP_OUT else -distance_m
        shape = Polygon(zone.vertices).buffer(outward, join_style="mitre", mitre_limit=2.0)
        parts = shape.geoms if isinstance(shape, MultiPolygon) else (shape,)
        for part in parts:
            if not part.is_empty:
                points += [(float(x), float(y)) for x, y in part.exterior.coords[:-1]]
    return tuple(points)
