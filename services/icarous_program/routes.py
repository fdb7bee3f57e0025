"""Routes that UxAS requests from an instance: WPREQ, answered by RPRSP with the corners of a route around the
zones.

All planners search for the shortest flyable chain of via points whose legs the proved kernels all permit
(`core.routing`); they differ in the via points. ASTAR uses the corners of rings around the zones, GRID a grid
over the places and zones, RRT pseudo-random samples of that area (always the same), and SPLINE is ASTAR
answered by points of the curve instead of its corners. UxAS trusts none of them: it checks the answer against
its own zones. Where zones separate the places, that is the answer, without a search; a search that does not end
within its time is given up before the next ring of via points, and the reason says so. A route that begins at the
vehicle is held against traffic too (`routes_in_time`).
"""

from __future__ import annotations

import math
import random
import time
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from cratous.bridge.text_protocol import Message, RouteEnd, RoutePoint, RouteRequest, RouteStart
from cratous.core.geofence.distance import FARTHER, edge_against
from cratous.core.kernel import Vec2
from cratous.core.requirements.verdict import reaches
from cratous.core.routing.bulk import FOUND
from cratous.core.routing.visibility import Roadmap, route, routes, why_not
from cratous.core.routing.wind import holds_in_wind
from cratous.services.flight.dynamics import Limits, turn_radius_m
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.icarous_program.routes_in_time import (
    Leg,
    Sky,
    begins_here,
    in_time,
    refused_by,
)
from cratous.services.loading.polygons import hard_zones
from cratous.services.mission.frames import Projection
from cratous.services.planning.spacing import TOLERANCE, spaced
from cratous.services.planning.zones import roadmaps
from cratous.services.ways_in_time.excluded import excluded
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa, Position, Zone
from cratous.spec.mission.plan import Pose

SIDE = 8
"""Number of points along each side of the grid."""
SAMPLES = SIDE * SIDE
AROUND = 4.0
"""Grid and samples extend beyond places and zones by this many turn radii."""
MOST_POINTS = 256
"""Longest answer that UxAS accepts."""
BUDGET_S = 0.5
"""An answer takes no longer than this [s], as far as one ring of via points tells of the next."""
CLIMBS_MOST_M = 200_000.0
"""A route that would have to be longer than this to reach its altitude is rejected [m]: it would be all
turns.
"""


class Clock:
    """The time of one answer, by a clock in seconds. Another search is begun only while as long as the longest so far
    is left.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s, self._begun_s = now_s, now_s()
        self._last_s, self._longest_s, self._asked = self._begun_s, 0.0, 0

    def leaves_no_time(self) -> bool:
        """Whether another search may end too late; asked before each."""
        now, asked = self._now_s(), self._asked
        if asked:
            self._longest_s = max(self._longest_s, now - self._last_s)
        self._last_s, self._asked = now, asked + 1
        ends = now + self._longest_s
        return bool(asked) and not reaches(self._begun_s + BUDGET_S, ends)

    def overdue(self) -> bool:
        """Whether the time is over."""
        return not reaches(self._begun_s + BUDGET_S, self._now_s())


class Planner(NamedTuple):
    """Route planner of one vehicle: projection of the local plane, airframe limits, what it keeps from traffic (None:
    not looked at), and a clock in seconds.
    """

    projection: Projection
    limits: Limits
    daa: Daa | None = None
    now_s: Callable[[], float] = time.monotonic

    def answer(
        self, asked: RouteRequest, zones: tuple[Zone, ...], sensed: Sensed | None = None
    ) -> tuple[list[Message], str]:
        """The lines that answer a route request, and the reason if the answer has no points, or if its points do not
        keep clear of traffic. sensed: what the instance last sensed, None before.
        """
        clock = Clock(self.now_s)
        try:
            points, why = self._plan(asked, zones, clock)
        except BadInput as error:
            points, why = (), str(error)
        legs = [(p, asked.horizontal_mps) for p in points]
        if sensed is not None and self.daa is not None and points:
            legs, why = self._past_traffic(asked, legs, zones, Sky(sensed, self.daa, clock.overdue))
        number, between = asked.request, list[Message]()
        for p, speed in legs:
            lat, lon = self.projection.to_geodetic(p.north_m, p.east_m)
            between.append(RoutePoint(lat, lon, p.alt_m, speed, number))
        return [RouteStart(number), *between, RouteEnd(number)], why

    def _past_traffic(
        self, asked: RouteRequest, legs: list[Leg], zones: tuple[Zone, ...], sky: Sky
    ) -> tuple[list[Leg], str]:
        """The legs of a route, or those of a way in time where traffic refuses it; the former, with the reason, if none
        is found.
        """
        points, speed = [p for p, _ in legs], asked.horizontal_mps
        start = Pose(*points[0], math.radians(asked.track_deg))
        if not begins_here(start, speed, sky):
            return legs, ""
        met = refused_by(points, start, speed, sky)
        if met is None:
            return legs, ""
        found, why = in_time(start, points[-1], speed, hard_zones(zones), sky)
        if len(found) > MOST_POINTS:
            why = f"its way past traffic has {len(found)} points, more than {MOST_POINTS}"
        if why:
            return legs, f"the route is not permitted against {met}; {why}"
        return found, ""

    def _plan(
        self, asked: RouteRequest, zones: tuple[Zone, ...], clock: Clock
    ) -> tuple[Sequence[Position], str]:
        speed = asked.horizontal_mps
        low, high = self.limits.min_speed_m_s, self.limits.max_speed_m_s
        if not holds_in_wind(max(speed, 0.0), 0.0, 0.0, low, high):
            return (), f"speed that this airframe cannot fly: expected {low:g} to {high:g} m/s"
        north, east = self.projection.to_local(asked.start_lat_deg, asked.start_long_deg)
        start = Pose(north, east, asked.start_alt_m, math.radians(asked.track_deg))
        north, east = self.projection.to_local(asked.end_lat_deg, asked.end_long_deg)
        straight = math.atan2(east - start.east_m, north - start.north_m)
        end = Pose(north, east, asked.end_alt_m, straight)
        radius = TURN_MARGIN * turn_radius_m(speed, self.limits.max_bank_rad)
        slope, why = self.limits.max_climb_m_s / speed, ""
        at_start, at_end = Vec2(start.alt_m, 0.0), Vec2(end.alt_m, 0.0)
        if edge_against(at_end, at_start, at_start, slope * CLIMBS_MOST_M) == FARTHER:
            rise = end.alt_m - start.alt_m
            return (), f"its altitude changes by {rise:.3g} m, too much for this airframe"
        if why := excluded(Position(*start[:3]), Position(*end[:3]), hard_zones(zones)):
            return (), why
        for roadmap in roadmaps(zones, radius):
            vias = _vias(asked.planner, roadmap, (start, end), AROUND * radius)
            for ring in vias.rings or ((),):
                if clock.leaves_no_time():
                    return (), f"none found in time ({BUDGET_S:g} s); so far: {why}"
                one = Roadmap(vias.zones, (ring,), vias.chord_error_m)
                points, why = _searched(asked.planner, start, end, radius, slope, one)
                if points:
                    return points, ""
        return (), why


def _searched(
    kind: str, start: Pose, end: Pose, radius_m: float, slope: float, roadmap: Roadmap
) -> tuple[Sequence[Position], str]:
    """Corners of the route (SPLINE: points of it) including both ends; none, with the reason, if there is no
    route.
    """
    if kind == "SPLINE":
        found = route(start, end, radius_m, roadmap, slope)
        off_m = TOLERANCE * radius_m
        points = spaced(found.points, radius_m, off_m, roadmap.zones) if found.points else ()
        why = found.reason
    else:
        ways = routes(
            np.array([start], float), np.array([end], float), radius_m, roadmap, slope, ways=True
        )
        links = int(ways.links[0])
        if ways.codes[0] != FOUND:
            return (), why_not(int(ways.codes[0]), roadmap.zones[links])
        points, why = tuple(Position(*p[:3]) for p in ways.poses[0][: links + 1].tolist()), ""
    if len(points) > MOST_POINTS:
        return (), f"its way has {len(points)} points, more than {MOST_POINTS}"
    return points, why


def _vias(kind: str, roadmap: Roadmap, ends: tuple[Pose, Pose], around_m: float) -> Roadmap:
    """The roadmap's zones with the via points of a planner."""
    if kind not in ("GRID", "RRT"):
        return roadmap
    places = [(p.north_m, p.east_m) for p in ends]
    places += [corner for zone in roadmap.zones for corner in zone.vertices]
    low = [min(p[k] for p in places) - around_m for k in (0, 1)]
    high = [max(p[k] for p in places) + around_m for k in (0, 1)]
    made = _grid(low, high) if kind == "GRID" else _samples(low, high)
    return Roadmap(roadmap.zones, (tuple(made),))


def _grid(low: list[float], high: list[float]) -> Iterator[tuple[float, float]]:
    step = [(high[k] - low[k]) / (SIDE - 1) for k in (0, 1)]
    return ((low[0] + i * step[0], low[1] + j * step[1]) for i in range(SIDE) for j in range(SIDE))


def _samples(low: list[float], high: list[float]) -> Iterator[tuple[float, float]]:
    draw = random.Random(SAMPLES)  # fixed seed: the same answer to the same request
    return ((draw.uniform(low[0], high[0]), draw.uniform(low[1], high[1])) for _ in range(SAMPLES))
