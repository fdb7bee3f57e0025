"""Polygons for displays: where an intruder would violate a volume, and which tracks lead to a violation.

A hazard zone is the set of intruder positions, for its present velocity, at which the horizontal volume is violated,
optionally swept by the alerting time. A contour is the area covered by straight flight on other tracks while in
conflict. Points are east, north [m] in the frame of the states. Both are for display: no verdict depends on them.
Tests compare their borders with the kernels.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from cratous.core.daa.engine import Seen, errors_of, region_level, tables_at
from cratous.core.daa.records import Relative
from cratous.core.daa.state import Aircraft
from cratous.core.daa.uncertainty import lost, lost_span
from cratous.core.kernel import Vec2, driver
from cratous.spec.daa.parameters import CYLINDER, TCPA, TEP, Parameters, Volume

STEPS = 180


class Polygon(NamedTuple):
    """A polygon about one intruder; points are east, north [m], not closed."""

    intruder: str
    points: tuple[tuple[float, float], ...]


def _far_end(volume: Volume, speed_m_s: float) -> Callable[[float], float]:
    """The forward extent of the zone at a lateral offset [m], for a relative speed."""
    d, reach = volume.dthr_m, volume.tthr_s * speed_m_s

    def round_end(y: float) -> float:
        return math.sqrt(max(d * d - y * y, 0.0))

    if volume.kind == CYLINDER or speed_m_s == 0:
        return round_end
    if volume.kind == TCPA:
        return lambda y: max(reach, round_end(y))
    if volume.kind == TEP:
        return lambda y: reach + round_end(y)
    # modified tau: an arc around the point half the distance flown in TTHR ahead
    square = d * d + reach * reach / 4
    return lambda y: reach / 2 + math.sqrt(max(square - y * y, 0.0))


def hazard_zone(own: Aircraft, other: Aircraft, volume: Volume, sweep_s: float = 0.0) -> Polygon:
    """The hazard zone of one intruder around the ownship; sweep_s: the alerting time, or 0."""
    u, v = own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s
    speed = math.hypot(u, v)
    ahead = (u / speed, v / speed) if speed > 0 else (0.0, 1.0)
    side = (ahead[1], -ahead[0])
    end = _far_end(volume, speed)
    line = []
    for k in range(STEPS + 1):
        # from the left to the right: the far end
        y = -volume.dthr_m * math.cos(math.pi * k / STEPS)
        line.append((end(y) + sweep_s * speed, y))
    for k in range(1, STEPS):
        # and back behind the ownship
        angle = math.pi * k / STEPS
        line.append((-volume.dthr_m * math.sin(angle), volume.dthr_m * math.cos(angle)))
    points = tuple(
        (
            own.east_m + x * ahead[0] + y * side[0],
            own.north_m + x * ahead[1] + y * side[1],
        )
        for x, y in line
    )
    return Polygon(other.id, points)


@driver(checked_by=("in_conflict", "conflict_span"))
def contours(p: Parameters, seen: Seen, i: int) -> list[Polygon]:
    """The contours of intruder i for the corrective region: tracks in steps of one degree."""
    own, other, a = seen.own, seen.others[i], seen.alerters[i]
    found = region_level(p.alerters[a], p.corrective_region) if a >= 0 else None
    if found is None:
        return []
    t = tables_at(p, own.alt_m)
    kind = int(t.kinds[a, found[0]])
    limits = np.concatenate([t.volumes[a, found[0]], errors_of(p, own, other)])
    s = Vec2(own.east_m - other.east_m, own.north_m - other.north_m)
    sz, vz = own.alt_m - other.alt_m, own.vu_m_s - other.vu_m_s
    speed, track = math.hypot(own.ve_m_s, own.vn_m_s), math.atan2(own.ve_m_s, own.vn_m_s)
    count = int(math.degrees(p.contour_thr_rad) + 1e-9)
    runs: list[list[tuple[tuple[float, float], tuple[float, float]]]] = [[]]
    for k in range(-count, count + 1):
        angle = track + math.radians(k)
        e, n = speed * math.sin(angle), speed * math.cos(angle)
        moving = Relative(s, Vec2(e - other.ve_m_s, n - other.vn_m_s), sz, vz)
        state: Any = (kind, moving, limits, 0.0)
        within: Any = lost
        times: Any = lost_span
        if not within(*state, 0.0, p.lookahead_time_s):
            runs.append([])
            continue
        first, last = times(*state, 0.0, p.lookahead_time_s)
        last = max(first, last)
        near = (own.east_m + first * e, own.north_m + first * n)
        runs[-1].append((near, (own.east_m + last * e, own.north_m + last * n)))
    return [
        Polygon(other.id, tuple([far for _, far in run] + [near for near, _ in reversed(run)]))
        for run in runs
        if len(run) > 1
    ]
