"""Flown or planned legs held against zones, exactly: the proved kernels on rational numbers.

Every double is a rational, so the verdict of `leg_ok` on rationals is exact for the doubles that
are given. Margins are distances in floating point, for display only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, cast

from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.geofence.planar import keep_in_leg_ok, keep_out_leg_ok
from cratous.core.kernel import qualified
from cratous.spec.mission import Position, Zone, ZoneKind


@lru_cache(maxsize=512)
def _rational(zone: Zone) -> Zone:
    exact: Any = Fraction
    return replace(
        zone,
        vertices=tuple((exact(n), exact(e)) for n, e in zone.vertices),
        floor_m=exact(zone.floor_m),
        ceiling_m=exact(zone.ceiling_m),
        padding_m=0,
    )


def exact_leg_ok(p: Position, q: Position, zone: Zone) -> bool:
    """True iff the leg from p to q obeys the zone; exact. The zone's vertices are effective."""
    one, other = (Position(*cast(Any, map(Fraction, point))) for point in (p, q))
    return leg_ok(one, other, _rational(zone))


def deciding(zone: Zone) -> tuple[str, str]:
    """The driver and the kernel that decide `exact_leg_ok` of a zone."""
    ends = keep_out_leg_ok if zone.kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    return qualified(leg_ok), qualified(ends)


def margin_m(distance: float, broken: bool) -> float:
    """The margin of a zone [m], negative where it is broken; on the boundary 0, never -0."""
    return 0.0 - distance if broken else distance


def distance_m(path: Sequence[Position], zone: Zone) -> float:
    """Least horizontal distance from a path to the zone's boundary [m]; for display only."""
    from shapely import LineString, Point, Polygon

    ring = Polygon(zone.vertices).exterior
    points = [(p.north_m, p.east_m) for p in path]
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return float(line.distance(ring))
