"""Flyable routes around zones: visibility graph, shortest path, turns, and a check of every leg.

A `Roadmap` holds the zones of one altitude range and rings of via points around them, from the tightest ring to the
widest (made by offsetting outside `core`). The search for a route, and the check of every leg of it by the proved
kernels, are in `core.routing.bulk`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from cratous.core.geofence.mission_leg_arrays import table
from cratous.core.readings.tiered import SOON, swift
from cratous.core.routing.bulk import (
    BAD_START,
    FOUND,
    LINKS_MOST,
    NO_WAY,
    NOT_DIRECT,
    Rings,
    Routed,
    Turning,
    direct_many,
    route_many,
    route_points,
)
from cratous.core.routing.dubins import RIGHT, pose_after
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

DIRECT_WORK, AROUND_WORK = 1, 3
"""CPython's work for a direct route beside zones, and for one around them, in the units of `swift`; without legs
against zones, and without lines of sight between via points (`_sight_work`).
"""
SIGHTS = 400
"""As many pairs of via points, times edges of zones, are one unit: about one pair in seven is looked at."""
BLOCK = 300
"""Number of routes searched per block: machine code compiled meanwhile by a parallel process is used from the next
block on.
"""


class Route(NamedTuple):
    """A flyable polyline and its length [m], to micrometres, or no points and the reason."""

    points: tuple[Position, ...]
    length_m: float
    reason: str = ""


@dataclass(eq=False)
class Roadmap:
    """Zones, and via points (north, east) per ring; caches which of those are mutually visible."""

    zones: tuple[Zone, ...]
    rings: tuple[tuple[tuple[float, float], ...], ...] = ()
    chord_error_m: float = 0.5
    _seen: dict[float, np.ndarray] = field(default_factory=dict)

    def seen(self, alt_m: float) -> np.ndarray:
        """Which via points are mutually visible at an altitude: filled in while routes are searched."""
        if alt_m not in self._seen:
            widest = self.ring_arrays[0].shape[1]
            self._seen[alt_m] = np.zeros((len(self.rings), widest, widest), np.int8)
        return self._seen[alt_m]

    @cached_property
    def ring_arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """The rings, padded to one length, and their sizes."""
        sizes = np.array([len(ring) for ring in self.rings], np.int64)
        rings = np.zeros((len(self.rings), max([*sizes, 1]), 2))
        for g, ring in enumerate(self.rings):
            rings[g, : len(ring)] = np.array(ring, float).reshape(-1, 2)
        return rings, sizes


def routes(
    starts: np.ndarray,
    ends: np.ndarray,
    radius_m: float,
    roadmap: Roadmap,
    max_slope: float = math.inf,
    *,
    ways: bool = False,
) -> Routed:
    """Routes for pairs of poses, arrays (n, 4) of north, east, altitude, heading, as `route` says.

    ways: keep the poses, for the polylines; else only the lengths.
    """
    n = len(starts)
    found = Routed(
        np.empty(n, np.int64), np.empty(n), np.empty(n, np.int64),
        np.empty((n if ways else 1, LINKS_MOST + 2, 4)),
    )  # fmt: skip
    turning = Turning(float(radius_m), float(max_slope), float(roadmap.chord_error_m))
    zones = table(roadmap.zones)
    poses, work = (starts, ends), DIRECT_WORK if roadmap.zones else 1
    _search(direct_many, work, poses, (turning, zones), found, np.arange(n))
    _around(starts, ends, turning, roadmap, found, np.flatnonzero(found.codes == NOT_DIRECT))
    return found


def lengths_around(
    starts: np.ndarray, ends: np.ndarray, radius_m: float, roadmap: Roadmap, max_slope: float
) -> Routed:
    """`routes` without the polylines, with the same lengths, for pairs of which many are expected to lead around
    zones.

    All of them go to `route_many`, so that `direct_many` need not be compiled as well.
    """
    n = len(starts)
    found = Routed(
        np.empty(n, np.int64), np.empty(n), np.empty(n, np.int64), np.empty((1, LINKS_MOST + 2, 4))
    )
    turning = Turning(float(radius_m), float(max_slope), float(roadmap.chord_error_m))
    _around(starts, ends, turning, roadmap, found, np.arange(n))
    return found


def _around(
    starts: np.ndarray,
    ends: np.ndarray,
    turning: Turning,
    roadmap: Roadmap,
    found: Routed,
    which: np.ndarray,
) -> None:
    """Search these routes around zones, grouped by altitude."""
    zones, altitudes = table(roadmap.zones), starts[which, 2]
    for alt in np.unique(altitudes):
        rings = Rings(*roadmap.ring_arrays, roadmap.seen(float(alt)))
        here = which[altitudes == alt]
        work = AROUND_WORK + _sight_work(rings, zones)
        _search(route_many, work, (starts, ends), (turning, zones, rings), found, here)


def _sight_work(rings: Rings, zones: tuple[np.ndarray, ...]) -> int:
    """CPython's work for the lines of sight that a route around zones tries along one ring, as `swift` counts it."""
    points = max(rings.sizes, default=0)
    unseen = 1 - np.count_nonzero(rings.seen) / max(rings.seen.size, 1)
    return int(unseen * points**2 * len(zones[-1]) / SIGHTS)


def _search(
    loop: Callable[..., None], work: int, poses: tuple[np.ndarray, ...], given: tuple[Any, ...], found: Routed,
    which: np.ndarray,
) -> None:  # fmt: skip
    """Search these routes with a loop, block by block; work: of one route; given: the loop's other arguments."""
    n = len(found.codes)
    for k in range(0, len(which), BLOCK):
        at = which[k : k + BLOCK]
        some = Routed(*(part[at] if len(part) == n else part for part in found))
        # the first block announces the total work; the others ask again which version to run
        run = swift(loop, SOON if k else len(which) * work)
        run(*(np.ascontiguousarray(part[at]) for part in poses), *given, some)
        for part, filled in zip(found, some, strict=True):
            if len(part) == n:
                part[at] = filled


def start_point(pose: Pose) -> Position:
    """The position of a pose."""
    return Position(pose.north_m, pose.east_m, pose.alt_m)


def why_not(code: int, zone: Zone) -> str:
    """Why there is no route, from its code and zone."""
    if code == NO_WAY:
        return f"no way around {name_of(zone)} was found"
    return f"its {'start' if code == BAD_START else 'end'} breaks {name_of(zone)}"


def route(
    start: Pose,
    end: Pose,
    radius_m: float,
    roadmap: Roadmap,
    max_slope: float = math.inf,
) -> Route:
    """A short flyable route from start to end whose every leg obeys the roadmap's zones.

    radius_m: turn radius [m]; max_slope: steepest climb or descent (metres per metre flown).
    The route is the shortest that was found, not the shortest that exists.
    """
    ends = np.array([start], float), np.array([end], float)
    found = routes(*ends, radius_m, roadmap, max_slope, ways=True)
    links = int(found.links[0])
    if found.codes[0] != FOUND:
        return Route((), 0.0, why_not(int(found.codes[0]), roadmap.zones[links]))
    points = swift(route_points, 1 + 20 * bool(roadmap.zones))(
        found.poses[0], links,
        Turning(float(radius_m), float(max_slope), float(roadmap.chord_error_m)),
        table(roadmap.zones),
    )  # fmt: skip
    inner = [Position(*point) for point in points[1:-1].tolist()]
    way = (start_point(start), *inner, start_point(end))
    return Route(way, float(found.metres[0]))


def name_of(zone: Zone) -> str:
    """A zone in words: kind, id and label."""
    kind = "keep-in" if zone.kind.value == "keep_in" else "keep-out"
    return f"{kind} zone {zone.id}" + (f" ({zone.label})" if zone.label else "")


def circle(
    at: Pose, radius_m: float, clockwise: bool, chord_error_m: float = 0.5
) -> tuple[Position, ...]:
    """One full turn from a pose back to it, as a polyline."""
    kind = RIGHT if clockwise else -RIGHT
    step = 2 * math.acos(max(0.0, 1 - chord_error_m / radius_m)) * radius_m
    count = max(8, math.ceil(2 * math.pi * radius_m / step))
    around = 2 * math.pi * radius_m
    points = [start_point(pose_after(at, kind, around * k / count, radius_m)) for k in range(count)]
    return (*points, points[0])
