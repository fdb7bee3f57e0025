"""A flyable way from where a vehicle is to a pose, around the zones."""

from __future__ import annotations

import math

from cratous.core.routing.dubins import cut, dubins
from cratous.core.routing.visibility import Roadmap, route
from cratous.services.flight.dynamics import AirState
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose


class Router:
    """Routes made in flight; the roadmaps around the zones are made once per turn radius."""

    def __init__(self, zones: tuple[Zone, ...]) -> None:
        self._zones = zones
        self._maps: dict[float, tuple[Roadmap, ...]] = {}

    def way_to(
        self, state: AirState, radius_m: float, target: Pose, max_slope: float = math.inf
    ) -> tuple[Position, ...]:
        """The planner's route to the pose; the shortest Dubins path if it finds none.

        The latter is for a vehicle that is already in a zone, or has no way: that it breaks a
        zone is then what ICAROUS and the monitor see.
        """
        radius = round(radius_m, 3)
        if radius not in self._maps:
            self._maps[radius] = roadmaps(self._zones, radius)
        for slope in (max_slope, math.inf):
            for roadmap in self._maps[radius]:
                found = route(state.pose, target, radius, roadmap, slope)
                if found.points:
                    return found.points
        return cut(dubins(state.pose, target, radius), target)
