"""How far the vehicles of a rendezvous are."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.following.meeting import Limits, lap_s, over_ground, waiting_circle
from cratous.services.following.part import Part
from cratous.services.following.service import Following
from cratous.services.planning.flyers import Flyer


class Way(NamedTuple):
    """What is left of a vehicle's way: left_m: to its state; waits: it can still wait; laps: it does; passed: it
    is beyond its state; arrived: by when it has come there [ms], None: not yet; wind: along its run-in and across
    it [m/s]; told: the Time of the state that says so [ms]; before: that of the one before; turn: the share of a lap until
    who waits heads for its state; here: where who waits is."""

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
        """The speeds of a vehicle over ground along its run-in."""
        return over_ground(limits, self.wind)

    def lap_s(self, flyer: Flyer) -> float:
        """How long a lap of waiting takes in this wind [s], at most ten times as long as without one."""
        return lap_s(flyer, self.wind)

    def airspeed(self, ground_m_s: float, limits: Limits) -> float:
        """The speed through the air, within its limits, at which it flies so fast over ground."""
        speed = math.hypot(ground_m_s - self.wind.x, self.wind.y)
        return min(max(speed, limits.slowest_m_s), limits.fastest_m_s)


class Progress(NamedTuple):
    """common: when all meet [ms], None: not set; ways: of the vehicles; gone: who have left their circles;
    since: of who waits, when it was told to [ms]; slow: who has come to its circle, and was told to wait slowly."""

    common: int | None = None
    ways: Mapping[int, Way] = MappingProxyType({})
    gone: frozenset[int] = frozenset()
    since: Mapping[int, int] = MappingProxyType({})
    slow: frozenset[int] = frozenset()

    def with_way(self, vehicle: int, way: Way) -> Progress:
        """With what is left of a vehicle's way."""
        return self._replace(ways={**self.ways, vehicle: way})


def heard(state: Following, vehicle: int, now_ms: int) -> Following:
    """With a vehicle heard now; of those that were never heard the time runs from now on."""
    parts = tuple(
        p._replace(seen_ms=now_ms) if p.vehicle == vehicle or not p.seen_ms else p
        for p in state.parts
    )
    return state._replace(parts=parts, now_ms=now_ms)


def place_of(part: Part) -> Vec2:
    """Where a vehicle is to be at the common time."""
    return Vec2(*part.option.path[1][:2])


def ahead_of(part: Part) -> Vec2:
    """The direction of its run-in."""
    heading = part.option.start.heading_rad
    return Vec2(math.cos(heading), math.sin(heading))


def turn_left(part: Part, body: Any) -> float:
    """The share of a lap until who waits heads for its state again."""
    off = part.option.start.heading_rad - math.radians(body.Heading)
    if not waiting_circle(part.option)[1]:
        off = -off
    return off % (2 * math.pi) / (2 * math.pi)
