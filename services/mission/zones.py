"""Flown or planned legs checked against zones, exactly: the proved kernels on rational numbers.

Every double is a rational, so the verdict of `leg_ok` on rationals is exact for the given doubles. Margins
are floating-point distances, for display only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from math import lcm
from typing import Any

from cratous.core.geofence.clearance import leg_keeps
from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.geofence.planar import keep_in_leg_ok, keep_out_leg_ok
from cratous.core.kernel import qualified
from cratous.spec.mission import Position, Zone, ZoneKind

PARTS = 1 << 60
"""Parts per metre in which nearly all doubles of at least 0.01 are whole numbers."""


@lru_cache(maxsize=512)
def _whole(zone: Zone, parts: int) -> Zone:
    """A zone in whole parts of a metre."""
    exact: Any = parts
    return replace(
        zone,
        vertices=tuple((_in_parts(n, exact), _in_parts(e, exact)) for n, e in zone.vertices),
        floor_m=_in_parts(zone.floor_m, exact),
        ceiling_m=_in_parts(zone.ceiling_m, exact),
        padding_m=0,
    )


@lru_cache(maxsize=512)
def _parts_of(zone: Zone) -> int:
    """Parts per metre in which all numbers of a zone are whole."""
    numbers = (zone.floor_m, zone.ceiling_m, *(x for vertex in zone.vertices for x in vertex))
    return lcm(PARTS, *(Fraction(x).denominator for x in numbers))


def _in_parts(value: float, parts: Any) -> Any:
    above, below = value.as_integer_ratio()
    return above * (parts // below)


def exact_leg_ok(p: Position, q: Position, zone: Zone) -> bool:
    """Whether the leg from p to q keeps the zone; exact. The zone's vertices are effective.

    It is computed in a unit of length in which all numbers are whole: `leg_ok` adds, multiplies and compares,
    so the answer is the same as in metres, in a fraction of the time that rationals take.
    """
    parts = lcm(_parts_of(zone), *(x.as_integer_ratio()[1] for point in (p, q) for x in point))
    one, other = (Position(*(_in_parts(x, parts) for x in point)) for point in (p, q))
    return leg_ok(one, other, _whole(zone, parts))


def exact_leg_keeps(p: Position, q: Position, zone: Zone, margin_m: float) -> bool:
    """Whether every flight within a margin [m, >= 0] of the leg, to the side, above and below, keeps the
    zone, as `leg_keeps` decides; exact like `exact_leg_ok`.
    """
    numbers = [x.as_integer_ratio()[1] for x in (margin_m, *p, *q)]
    parts = lcm(_parts_of(zone), *numbers)
    one, other = (Position(*(_in_parts(x, parts) for x in point)) for point in (p, q))
    margin = _in_parts(margin_m, parts)
    return leg_keeps(one, other, _whole(zone, parts), margin, margin)


def deciding(zone: Zone) -> tuple[str, str]:
    """The driver and the kernel that decide `exact_leg_ok` for a zone."""
    ends = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    return qualified(leg_ok), qualified(ends)


def margin_m(distance: float, broken: bool) -> float:
    """The margin to a zone [m], negative if violated; 0 on the boundary, never -0."""
    return 0.0 - distance if broken else distance


def distance_m(path: Sequence[Position], zone: Zone) -> float:
    """Smallest horizontal distance from a path to the zone's boundary [m]; for display only."""
    from shapely import LineString, Point, Polygon

    ring = Polygon(zone.vertices).exterior
    points = [(p.north_m, p.east_m) for p in path]
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return float(line.distance(ring))
