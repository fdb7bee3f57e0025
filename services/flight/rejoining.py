"""A flyable route from a vehicle's state to a pose, around the zones."""

from __future__ import annotations

import itertools
import math

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import cut, dubins
from cratous.core.routing.visibility import Roadmap, route
from cratous.services.flight.dynamics import AirState
from cratous.services.planning.zone_exits import entered, way_out
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

Way = tuple[Position, ...]


class Router:
    """Routes made in flight; caches the roadmaps around the zones by turn radius."""

    def __init__(self, zones: tuple[Zone, ...]) -> None:
        self._zones = zones
        self._maps: dict[tuple[float, tuple[Zone, ...]], tuple[Roadmap, ...]] = {}

    def way_to(
        self, state: AirState, radius_m: float, target: Pose, max_slope: float = math.inf
    ) -> Way:
        """A route to the pose that breaks no zone; empty if none is found.

        The planner's route, else the shortest Dubins path if its legs keep the zones. A zone that the vehicle
        is inside is left at once, by the shortest level way found, and not entered again; ICAROUS and the
        monitor see the violation. If no route continues from there, the zone is left along the route instead.
        """
        radius = round(radius_m, 3)
        out = way_out(state.pose, radius, self._zones)
        begun, start = (out.points[:-1], out.end) if out else ((), state.pose)
        inside = entered(state.position, self._zones)
        found = self._around(start, target, (radius, max_slope), () if out else inside)
        if found or out is None:
            return (*begun, *found)
        return self._around(state.pose, target, (radius, max_slope), inside)

    def _around(
        self, start: Pose, target: Pose, turning: tuple[float, float], inside: tuple[Zone, ...]
    ) -> Way:
        """A route around all zones, except that those in `inside` are left along it. turning: radius [m],
        steepest slope.
        """
        radius, max_slope = turning
        kept = tuple(zone for zone in self._zones if zone not in inside)
        for slope in (max_slope, math.inf):
            for roadmap in self._roadmaps(radius, kept):
                found = route(start, target, radius, roadmap, slope).points
                if found and _leaves(found, inside):
                    return found
        direct = cut(dubins(start, target, radius), target)
        clear = first_bad_leg(direct, kept) is None and _leaves(direct, inside)
        return direct if clear else ()

    def _roadmaps(self, radius: float, zones: tuple[Zone, ...]) -> tuple[Roadmap, ...]:
        key = radius, zones
        if key not in self._maps:
            self._maps[key] = roadmaps(zones, radius)
        return self._maps[key]


def _leaves(way: Way, inside: tuple[Zone, ...]) -> bool:
    """Whether a route leaves each of these zones and does not enter it again."""
    for zone in inside:
        clear = [first_bad_leg(leg, (zone,)) is None for leg in itertools.pairwise(way)]
        if clear[-1:] != [True] or clear != sorted(clear):
            return False
    return True
