"""How much of what a search has to see lies where a vehicle may fly, at one altitude: outside the zones.

A point of a line counts if a vehicle there obeys every zone (`leg_ok` of the leg from it to itself). An area is
divided into squares; one that shares a point with a forbidden region counts in full as forbidden, so the share is
never more than what lies outside. Zones have their padding turned into vertices.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.geofence.planar import keep_in_leg_ok, keep_out_leg_ok
from cratous.core.kernel import driver
from cratous.core.readings.tiered import swift
from cratous.core.tasks.coverage import (
    Corner,
    area_m2,
    share_covered,
    square_array,
    square_side_m,
)
from cratous.core.tasks.coverage_arrays import grid_squares
from cratous.spec.mission import Position, Zone, ZoneKind

AROUND_M = 100.0
"""Margin by which the box extends beyond the area and a keep-in; its part outside the keep-in is forbidden [m]."""


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "meets_boundary"))
def points_outside(points: Sequence[Corner], alt_m: float, zones: Sequence[Zone]) -> float:
    """The share of points (north, east) [m] at which a vehicle at this altitude obeys the zones; 1 without any."""
    free = sum(first_bad_leg((Position(n, e, alt_m),), zones) is None for n, e in points)
    return free / len(points) if points else 1.0


@driver(checked_by=("location_step", "contact_step", "keep_out_leg_ok", "keep_in_leg_ok"))
def area_outside(vertices: tuple[Corner, ...], alt_m: float, zones: Sequence[Zone]) -> float:
    """Lower bound of the share of a simple polygon that lies where a vehicle at this altitude obeys the zones."""
    import numpy as np

    side_m = square_side_m(vertices)
    low = np.array(vertices, float).min(axis=0)

    def cells(centres: Any) -> set[tuple[int, int]]:
        rows = np.rint((centres - low) / side_m - 0.5).astype(np.int64)
        return {(int(i), int(j)) for i, j in rows}

    whole, forbidden = cells(square_array(vertices, side_m)), set[tuple[int, int]]()
    for zone in zones:
        if zone.kind is ZoneKind.KEEP_OUT:
            if keep_out_leg_ok(1, True, alt_m, alt_m, zone.floor_m, zone.ceiling_m):
                continue
            rings = [zone.vertices]
        elif keep_in_leg_ok(1, False, alt_m, alt_m, zone.floor_m, zone.ceiling_m):
            rings = [zone.vertices, _box((*vertices, *zone.vertices))]
        else:
            return 0.0
        forbidden |= whole & cells(_met(vertices, rings, side_m))
    return share_covered(len(forbidden), side_m, area_m2(vertices))


def _met(vertices: Sequence[Corner], rings: Sequence[Sequence[Corner]], side_m: float) -> Any:
    """Centres of the squares of the area's grid that share a point with the region between the rings."""
    import numpy as np

    corners = np.array(vertices, float)
    low, span = corners.min(axis=0), np.ptp(corners, axis=0)
    rows, columns = (max(1, int(np.ceil(gap / side_m))) for gap in span.tolist())
    edges = [(*p, *q) for ring in rings for p, q in pairwise((*ring, ring[0]))]
    found = np.empty((rows * columns, 2))
    count = swift(grid_squares, rows * columns // 4)(
        np.array(edges, float), float(low[0]), float(low[1]), rows, columns, side_m, found
    )
    return found[:count].copy()


def _box(points: Sequence[Corner]) -> tuple[Corner, ...]:
    norths, easts = [p[0] for p in points], [p[1] for p in points]
    south, north = min(norths) - AROUND_M, max(norths) + AROUND_M
    west, east = min(easts) - AROUND_M, max(easts) + AROUND_M
    return ((south, west), (south, east), (north, east), (north, west))
