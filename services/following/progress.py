"""Progress of the vehicles of a rendezvous."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.tasks.rendezvous import beyond
from cratous.core.tasks.stations import in_ring
from cratous.services.following.rendezvous_options import is_direct, waiting_circle, waits_as
from cratous.services.following.service import Following
from cratous.services.following.speeds import Limits, lap_s, over_ground
from cratous.services.following.vehicle_part import Part
from cratous.services.planning.performance_classes import Flyer

NEAR_GATE = 1.5
"""A waiting circle is left within this many of its radii from the gate."""


class Way(NamedTuple):
    """The rest of a vehicle's route.

    left_m: distance to its state; waits: it can still wait; laps: it is waiting; passed: it is beyond its
    state; arrived: when it arrived there [ms], None: not yet; wind: along and across its run-in [m/s]; told:
    Time of the latest state [ms]; before: of the one before; turn: fraction of a lap until a waiting vehicle
    heads for its state; here: its position while waiting.
    """

    left_m: float
    waits: bool
    laps: bool = False
    passed: bool = False
    arrived: int | None = None
    wind: Vec2 = Vec2(0.0, 0.0)
    told: int = 0
    before: int = 0
    turn: float = 0.0
    here: Vec2 = Vec2(0.0, 0.0)

    def over_ground(self, limits: Limits) -> Limits:
        """The vehicle's speeds over ground along its run-in."""
        return over_ground(limits, self.wind)

    def lap_s(self, flyer: Flyer) -> float:
        """Duration of a waiting lap in this wind [s], at most ten times that without wind."""
        return lap_s(flyer, self.wind)

    def airspeed(self, ground_m_s: float, limits: Limits) -> float:
        """Airspeed, within its limits, for a ground speed [m/s]."""
        speed = math.hypot(ground_m_s - self.wind.x, self.wind.y)
        return min(max(speed, limits.slowest_m_s), limits.fastest_m_s)


class Progress(NamedTuple):
    """common: common arrival time [ms], None if not set; ways: by vehicle; gone: vehicles that have left
    their circles; since: when each waiting vehicle was commanded to wait [ms]; slow: vehicles on their
    circle that wait at low speed.
    """

    common: int | None = None
    ways: Mapping[int, Way] = MappingProxyType({})
    gone: frozenset[int] = frozenset()
    since: Mapping[int, int] = MappingProxyType({})
    slow: frozenset[int] = frozenset()

    def with_way(self, vehicle: int, way: Way) -> Progress:
        """The progress with the rest of a vehicle's route."""
        return self._replace(ways={**self.ways, vehicle: way})


def heard(state: Following, vehicle: int, now_ms: int) -> Following:
    """The state after a vehicle was heard; for vehicles never heard, the time of silence starts now."""
    parts = tuple(
        p._replace(seen_ms=now_ms) if p.vehicle == vehicle or not p.seen_ms else p
        for p in state.parts
    )
    return state._replace(parts=parts, now_ms=now_ms)


def place_of(part: Part) -> Vec2:
    """The position that a vehicle passes at the common time."""
    return Vec2(*part.option.path[-2][:2])


def ahead_of(part: Part) -> Vec2:
    """Unit vector of the direction in which a vehicle passes its place."""
    heading = part.option.end.heading_rad
    return Vec2(math.cos(heading), math.sin(heading))


def course_of(part: Part, here: Vec2) -> float:
    """Heading of the rest of a vehicle's route [rad]; on a direct route, before its end, that of the straight
    line.
    """
    path, at = part.option.path, place_of(part)
    if not is_direct(part.option) or in_ring(at, here, 0, math.dist(path[-3][:2], at)):
        return part.option.end.heading_rad
    return math.atan2(at.y - here.y, at.x - here.x)


def way_left(
    part: Part, here: Vec2, number: int, laps: bool, gone: bool, plan: Mapping[int, Any]
) -> Way:
    """The rest of a vehicle's route. number: its next waypoint; plan: its waypoints by number."""
    at, gate = place_of(part), Vec2(part.option.start.north_m, part.option.start.east_m)
    on = part.begins + 1 if laps or not gone else number
    if laps:
        return Way(_along(part, here, on, plan), True, True, here=here)
    if not gone:
        left = math.dist(here, gate) + _along(part, gate, on, plan)
        return Way(left, True, here=here)
    if is_direct(part.option) and number < part.then - 2:  # not yet on the straight end
        return Way(_along(part, here, on, plan), False)
    ahead = ahead_of(part)
    along_m = (at.x - here.x) * ahead.x + (at.y - here.y) * ahead.y
    return Way(max(along_m, 0.0), False, False, beyond(here, at, ahead))


def _along(part: Part, here: Vec2, number: int, plan: Mapping[int, Any]) -> float:
    """Distance from here to a waypoint and along the plan to the place [m]; straight where that is the route."""
    at, points = place_of(part), [plan.get(k) for k in range(number, part.then)]
    if not is_direct(part.option) or not points or None in points:
        return math.dist(here, at)
    along = [here, *(Vec2(*point[:2]) for point in points if point is not None)]
    past = math.dist(at, part.option.path[-1][:2])
    return max(sum(math.dist(p, q) for p, q in pairwise(along)) - past, 0.0)


def turn_left(part: Part, body: Any) -> float:
    """Fraction of a lap until a waiting vehicle heads for its state again."""
    off = part.option.start.heading_rad - math.radians(body.Heading)
    if not waiting_circle(part.option)[1]:
        off = -off
    return off % (2 * math.pi) / (2 * math.pi)


def at_gate(part: Part, here: Vec2, heading_deg: float) -> bool:
    """Whether a waiting vehicle is near its gate and heads along its route, within 45 degrees."""
    gate, heading = part.option.start, math.radians(heading_deg)
    toward, origin = Vec2(math.cos(heading), math.sin(heading)), Vec2(0.0, 0.0)
    reach_m = NEAR_GATE * waits_as(part.option).radius_m
    near = in_ring(Vec2(gate.north_m, gate.east_m), here, 0, reach_m)
    ahead = Vec2(math.cos(gate.heading_rad), math.sin(gate.heading_rad))
    left = Vec2(ahead.x + ahead.y, ahead.y - ahead.x)
    right = Vec2(ahead.x - ahead.y, ahead.y + ahead.x)
    return near and beyond(toward, origin, left) and beyond(toward, origin, right)
