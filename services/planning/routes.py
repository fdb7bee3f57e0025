"""Ways between tasks: travel times for the assignment, polylines for the plan. Each found once."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from typing import Protocol

import numpy as np

from cratous.core.assignment.problem import START
from cratous.core.routing.bulk import FOUND
from cratous.core.routing.visibility import Roadmap, Route, route, routes
from cratous.services.planning.options import Flyer, flight_ms, flyer_of
from cratous.services.planning.vias import Flown, inner, joined
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Pose

Ends = tuple[Pose, Flyer, Pose]
"""What a route depends on: where it begins, the class of the vehicle, where it ends."""


class Ending(Protocol):
    """An option, or anything else with a pose to go to and one to leave from."""

    @property
    def start(self) -> Pose:
        """Where a way to it ends."""

    @property
    def end(self) -> Pose:
        """Where a way from it begins."""


class Routes:
    """Routes of a mission's vehicles from their starts and from option to option.

    Vehicles are indices into `mission.vehicles`, options indices into `options`; from START means
    from where the vehicle is.
    """

    def __init__(
        self,
        mission: Mission,
        starts: Mapping[int, Pose],
        options: Sequence[Ending],
        zones: Sequence[Zone],
    ) -> None:
        self.options = options
        self.poses = [starts[vehicle.id] for vehicle in mission.vehicles]
        self.flyers = [flyer_of(vehicle) for vehicle in mission.vehicles]
        self.zones = tuple(zones)
        self._maps: dict[float, tuple[Roadmap, ...]] = {}
        self._found: dict[Ends, Route] = {}
        self._times: dict[Ends, int | None] = {}

    def between(self, options: Sequence[Ending]) -> Routes:
        """The same routes between other ends; what either finds, both have."""
        other = copy(self)
        other.options = options
        return other

    def _ends(self, vehicle: int, before: int, to: int) -> Ends:
        start = self.poses[vehicle] if before == START else self.options[before].end
        return start, self.flyers[vehicle], self.options[to].start

    def route(self, vehicle: int, before: int, to: int) -> Route:
        """The route, or none with the reason."""
        key = self._ends(vehicle, before, to)
        if key not in self._found:
            self._found[key] = self._search(*key)
        return self._found[key]

    def over(self, vehicle: int, before: int, to: int, points: Sequence[Position]) -> Route:
        """The route over the places that somebody else has found, or none and why it is no route here.

        They have to end where the route does and to keep between its altitudes; the climb is spread evenly.
        Legs between them are put to the proved kernels as those of any route.
        """
        start, flyer, end = self._ends(vehicle, before, to)
        vias, why = inner(start, end, points)
        if why:
            return Route((), 0.0, why)
        found = Route((), 0.0, "no way over its places")
        for roadmap in self._roadmaps(flyer.radius_m):
            found = joined(start, end, vias, Flown(flyer.radius_m, _slope(flyer)), roadmap.zones)
            if found.points:
                break
        return found

    def _roadmaps(self, radius_m: float) -> tuple[Roadmap, ...]:
        if radius_m not in self._maps:
            self._maps[radius_m] = roadmaps(self.zones, radius_m)
        return self._maps[radius_m]

    def kept_clear(self, radius_m: float) -> tuple[Zone, ...]:
        """The zones with the margin for tracking that routes of a turn radius keep where there is room."""
        return self._roadmaps(radius_m)[0].zones

    def _search(self, start: Pose, flyer: Flyer, end: Pose) -> Route:
        if flyer.max_climb_m_s <= 0 and start.alt_m != end.alt_m:
            return Route((), 0.0, "it cannot change its altitude")
        found = Route((), 0.0, "")
        for roadmap in self._roadmaps(flyer.radius_m):
            found = route(start, end, flyer.radius_m, roadmap, _slope(flyer))
            if found.points:
                break
        return found

    def prepare(self, vehicle: int, pairs: Iterable[tuple[int, int]]) -> None:
        """Find the times of many (before, to) at once, each pair of poses of a class once."""
        wanted = dict.fromkeys(self._ends(vehicle, *pair) for pair in pairs)
        left = [key for key in wanted if key not in self._times]
        flyer = self.flyers[vehicle]
        if flyer.max_climb_m_s <= 0:
            flat = [key for key in left if key[0].alt_m == key[2].alt_m]
            self._times.update((key, None) for key in left if key not in set(flat))
            left = flat
        for roadmap in self._roadmaps(flyer.radius_m):
            if not left:
                return
            starts, ends = (np.array([key[k] for key in left], float) for k in (0, 2))
            found = routes(starts, ends, flyer.radius_m, roadmap, _slope(flyer))
            rest = []
            for key, code, metres in zip(left, found.codes, found.metres.tolist(), strict=True):
                if code == FOUND:
                    self._times[key] = flight_ms(metres, flyer.speed_m_s)
                else:
                    rest.append(key)
            left = rest
        self._times.update((key, None) for key in left)

    def travel_ms(self, vehicle: int, before: int, to: int) -> int | None:
        """Travel time [ms], or None if no route was found."""
        key = self._ends(vehicle, before, to)
        if key not in self._times:
            self.prepare(vehicle, [(before, to)])
        return self._times[key]


def _slope(flyer: Flyer) -> float:
    """Metres of climb per metre flown; any, where a vehicle only flies level."""
    return flyer.max_climb_m_s / flyer.speed_m_s if flyer.max_climb_m_s > 0 else math.inf
