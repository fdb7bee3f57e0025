"""Routes between tasks: travel times for the assignment, polylines for the plan. Each is computed once."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from copy import copy
from typing import Protocol

import numpy as np

from cratous.core.assignment.problem import START
from cratous.core.routing.bulk import FOUND
from cratous.core.routing.visibility import Roadmap, Route, lengths_around, route, routes
from cratous.services.planning import pending_compilation
from cratous.services.planning.detours import many_detours
from cratous.services.planning.options import Flyer, flight_ms, flyer_of
from cratous.services.planning.via_points import Flown, inner, joined
from cratous.services.planning.zone_exits import WayOut, way_out
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Pose

Ends = tuple[Pose, Flyer, Pose]
"""What a route depends on: start pose, vehicle class, end pose."""
Leg = tuple[Pose, Pose]
"""The ends of a route of a known vehicle class."""


class Ending(Protocol):
    """An option, or anything else with a pose to arrive at and one to depart from."""

    @property
    def start(self) -> Pose:
        """End pose of a route to it."""

    @property
    def end(self) -> Pose:
        """Start pose of a route from it."""


class Routes:
    """Routes of a mission's vehicles from their starts and from option to option.

    Vehicles are indices into `mission.vehicles`, options indices into `options`; START means the vehicle's
    position. In flight (`flying`) a route from inside a zone begins with the shortest level way out that was
    found.
    """

    def __init__(
        self,
        mission: Mission,
        starts: Mapping[int, Pose],
        options: Sequence[Ending],
        zones: Sequence[Zone],
        flying: bool = False,
    ) -> None:
        self.options = options
        self.poses = [starts[vehicle.id] for vehicle in mission.vehicles]
        # routes depend on no camera, so that vehicles that differ in theirs share them
        self.flyers = [flyer_of(vehicle)._replace(cameras=()) for vehicle in mission.vehicles]
        self.zones, self.flying = tuple(zones), flying
        self._out: dict[tuple[Pose, float], WayOut | None] = {}
        self._maps: dict[float, tuple[Roadmap, ...]] = {}
        self._found: dict[Ends, Route] = {}
        self._times: dict[Flyer, dict[Leg, int | None]] = {flyer: {} for flyer in self.flyers}
        self._times_of = [self._times[flyer] for flyer in self.flyers]

    def between(self, options: Sequence[Ending]) -> Routes:
        """The same routes between other ends; both share one cache."""
        other = copy(self)
        other.options = options
        return other

    def take_over(self, earlier: Routes, known: Collection[Pose]) -> None:
        """Reuse times found between these poses, among the same zones by the same vehicles."""
        if any(self._times.values()) or earlier.flying != self.flying:
            return
        self._maps.update(earlier._maps)
        for flyer, times in earlier._times.items():
            mine = self._times.get(flyer, {})
            for leg, ms in times.items():
                if leg[0] in known and leg[1] in known:
                    mine[leg] = ms

    def _leg(self, vehicle: int, before: int, to: int) -> Leg:
        start = self.poses[vehicle] if before == START else self.options[before].end
        return start, self.options[to].start

    def _ends(self, vehicle: int, before: int, to: int) -> Ends:
        start, end = self._leg(vehicle, before, to)
        return start, self.flyers[vehicle], end

    def route(self, vehicle: int, before: int, to: int) -> Route:
        """The route, or none with the reason."""
        key = self._ends(vehicle, before, to)
        if key not in self._found:
            found = self._found[key] = self._search(*key)
            ms = flight_ms(found.length_m, key[1].speed_m_s) if found.points else None
            self._times_of[vehicle].setdefault((key[0], key[2]), ms)
        return self._found[key]

    def over(self, vehicle: int, before: int, to: int, points: Sequence[Position]) -> Route:
        """The route through the points of another planner, or none with the reason.

        They must end where the route does and stay between its altitudes; the climb is spread evenly. The
        proved kernels check the legs between them as those of any route.
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
        """The zones with the tracking margin that routes of a turn radius keep where there is room."""
        return self._roadmaps(radius_m)[0].zones

    def _way_out(self, start: Pose, radius_m: float) -> WayOut | None:
        """The way out of the zones in which a route begins; None if it begins in none, or on the ground
        before flight.
        """
        if not self.flying:
            return None
        if (start, radius_m) not in self._out:
            self._out[start, radius_m] = way_out(start, radius_m, self.zones)
        return self._out[start, radius_m]

    def _search(self, start: Pose, flyer: Flyer, end: Pose) -> Route:
        out = self._way_out(start, flyer.radius_m)
        if out is not None:
            found = self._around(out.end, flyer, end)
            points = (*out.points, *found.points[1:])
            return Route(points, out.length_m + found.length_m) if found.points else found
        return self._around(start, flyer, end)

    def _around(self, start: Pose, flyer: Flyer, end: Pose) -> Route:
        if flyer.max_climb_m_s <= 0 and start.alt_m != end.alt_m:
            return Route((), 0.0, "it cannot change its altitude")
        found = Route((), 0.0, "")
        for roadmap in self._roadmaps(flyer.radius_m):
            found = route(start, end, flyer.radius_m, roadmap, _slope(flyer))
            if found.points:
                break
        return found

    def prepare(self, vehicle: int, pairs: Iterable[tuple[int, int]]) -> None:
        """Compute the travel times of many (before, to) pairs at once, each pair of poses of a class once."""
        wanted = dict.fromkeys(self._leg(vehicle, *pair) for pair in pairs)
        flyer, times = self.flyers[vehicle], self._times_of[vehicle]
        left = [leg for leg in wanted if leg not in times]
        if flyer.max_climb_m_s <= 0:
            times.update((leg, None) for leg in left if leg[0].alt_m != leg[1].alt_m)
            left = [leg for leg in left if leg[0].alt_m == leg[1].alt_m]
        around = len(left) > pending_compilation.MANY_WAYS and self._lead_around(left)
        kind = pending_compilation.AROUND if around else pending_compilation.ROUTES
        if len(left) > pending_compilation.WORTH_WAITING[kind]:
            pending_compilation.ready(kind)
        for roadmap in self._roadmaps(flyer.radius_m):
            if not left:
                return
            outs = [self._way_out(start, flyer.radius_m) for start, _ in left]
            begun = [out.end if out else leg[0] for out, leg in zip(outs, left, strict=True)]
            starts, ends = np.array(begun, float), np.array([leg[1] for leg in left], float)
            search = lengths_around if around else routes
            found = search(starts, ends, flyer.radius_m, roadmap, _slope(flyer))
            rest = []
            for leg, out, code, metres in zip(
                left, outs, found.codes.tolist(), found.metres.tolist(), strict=True
            ):
                if code == FOUND:
                    way_m = metres + (out.length_m if out else 0.0)
                    times[leg] = flight_ms(way_m, flyer.speed_m_s)
                else:
                    rest.append(leg)
            left = rest
        times.update((leg, None) for leg in left)

    def _lead_around(self, ways: Sequence[Leg]) -> bool:
        """Whether many of these routes are expected to lead around zones."""
        starts, ends = (np.array([leg[k][:2] for leg in ways], float) for k in (0, 1))
        return many_detours(starts, ends, self.zones)

    def travel_ms(self, vehicle: int, before: int, to: int) -> int | None:
        """Travel time [ms], or None if no route was found."""
        leg, times = self._leg(vehicle, before, to), self._times_of[vehicle]
        if leg not in times:
            self.prepare(vehicle, [(before, to)])
        return times[leg]


def _slope(flyer: Flyer) -> float:
    """Metres of climb per metre flown; infinite for a vehicle that only flies level."""
    return flyer.max_climb_m_s / flyer.speed_m_s if flyer.max_climb_m_s > 0 else math.inf
