"""Ways between tasks: travel times for the assignment, polylines for the plan. Each found once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from cratous.core.assignment import START
from cratous.core.dubins import cut_length_m, dubins
from cratous.core.visibility import Roadmap, Route, route
from cratous.services.planning.options import Flyer, Option, flight_ms, flyer_of
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Mission, Zone
from cratous.spec.plan import Pose


class Routes:
    """Routes of a mission's vehicles from their starts and from option to option.

    Vehicles are indices into `mission.vehicles`, options indices into `options`; from START means
    from where the vehicle is.
    """

    def __init__(
        self,
        mission: Mission,
        starts: Mapping[int, Pose],
        options: Sequence[Option],
        zones: Sequence[Zone],
    ) -> None:
        self.options = options
        self.poses = [starts[vehicle.id] for vehicle in mission.vehicles]
        self.flyers = [flyer_of(vehicle) for vehicle in mission.vehicles]
        self.zones = tuple(zones)
        self._maps: dict[float, tuple[Roadmap, ...]] = {}
        self._found: dict[tuple[Pose, Flyer, Pose], Route] = {}
        self._times: dict[tuple[Pose, Flyer, Pose], int | None] = {}

    def _ends(self, vehicle: int, before: int, to: int) -> tuple[Pose, Flyer, Pose]:
        start = self.poses[vehicle] if before == START else self.options[before].end
        return start, self.flyers[vehicle], self.options[to].start

    def route(self, vehicle: int, before: int, to: int) -> Route:
        """The route, or none with the reason."""
        key = self._ends(vehicle, before, to)
        if key not in self._found:
            self._found[key] = self._search(*key)
        return self._found[key]

    def _search(self, start: Pose, flyer: Flyer, end: Pose) -> Route:
        slope = flyer.max_climb_m_s / flyer.speed_m_s if start.alt_m != end.alt_m else math.inf
        if slope <= 0:
            return Route((), 0.0, "it cannot change its altitude")
        radius = flyer.radius_m
        if radius not in self._maps:
            self._maps[radius] = roadmaps(self.zones, radius)
        found = Route((), 0.0, "")
        for roadmap in self._maps[radius]:
            found = route(start, end, radius, roadmap, slope)
            if found.points:
                break
        return found

    def travel_ms(self, vehicle: int, before: int, to: int) -> int | None:
        """Travel time [ms], or None if no route was found."""
        key = self._ends(vehicle, before, to)
        if key not in self._times:
            start, flyer, end = key
            if not self.zones and start.alt_m == end.alt_m:
                length: float | None = cut_length_m(dubins(start, end, flyer.radius_m))
            else:
                found = self.route(vehicle, before, to)
                length = found.length_m if found.points else None
            self._times[key] = None if length is None else flight_ms(length, flyer.speed_m_s)
        return self._times[key]
