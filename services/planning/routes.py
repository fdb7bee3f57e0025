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
        self.flyers = [flyer_of(vehicle) for vehicle in mission.vehicles]
        self.zones, self.flying = tuple(zones), flying
        self._out: dict[tuple[Pose, float], WayOut | None] = {}
        self._maps: dict[float, tuple[Roadmap, ...]] = {}
        self._found: dict[Ends, Route] = {}
        self._times: dict[Ends, int | None] = {}

    def between(self, options: Sequence[Ending]) -> Routes:
        """The same routes between other ends; both share one cache."""
        other = copy(self)
        other.options = options
        return other

    def take_over(self, earlier: Routes, known: Collection[Pose]) -> None:
        """Reuse times found between these poses, among the same zones by the same vehicles."""
        if self._times or earlier.flying != self.flying:
            return
        self._maps.update(earlier._maps)
        for ends, ms in earlier._times.items():
            if ends[0] in known and ends[2] in known:
                self._times[ends] = ms

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
        wanted = dict.fromkeys(self._ends(vehicle, *pair) for pair in pairs)
        left = [key for key in wanted if key not in self._times]
        flyer = self.flyers[vehicle]
        if flyer.max_climb_m_s <= 0:
            flat = [key for key in left if key[0].alt_m == key[2].alt_m]
            self._times.update((key, None) for key in left if key not in set(flat))
            left = flat
        around = len(left) > pending_compilation.MANY_WAYS and self._lead_around(left)
        kind = pending_compilation.AROUND if around else pending_compilation.ROUTES
        if len(left) > pending_compilation.WORTH_WAITING[kind]:
            pending_compilation.ready(kind)
        for roadmap in self._roadmaps(flyer.radius_m):
            if not left:
                return
            outs = [self._way_out(start, flyer.radius_m) for start, _, _ in left]
            begun = [out.end if out else key[0] for out, key in zip(outs, left, strict=True)]
            starts, ends = np.array(begun, float), np.array([key[2] for key in left], float)
            search = lengths_around if around else routes
            found = search(starts, ends, flyer.radius_m, roadmap, _slope(flyer))
            rest = []
            for key, out, code, metres in zip(
                left, outs, found.codes, found.metres.tolist(), strict=True
            ):
                if code == FOUND:
                    way_m = metres + (out.length_m if out else 0.0)
                    self._times[key] = flight_ms(way_m, flyer.speed_m_s)
                else:
                    rest.append(key)
            left = rest
        self._times.update((key, None) for key in left)

    def _lead_around(self, ways: Sequence[Ends]) -> bool:
        """Whether many of these routes are expected to lead around zones."""
        starts, ends = (np.array([key[k][:2] for key in ways], float) for k in (0, 2))
        return many_detours(starts, ends, self.zones)

    def travel_ms(self, vehicle: int, before: int, to: int) -> int | None:
        """Travel time [ms], or None if no route was found."""
        key = self._ends(vehicle, before, to)
        if key not in self._times:
            self.prepare(vehicle, [(before, to)])
        return self._times[key]


def _slope(flyer: Flyer) -> float:
    """Metres of climb per metre flown; infinite for a vehicle that only flies level."""
    return flyer.max_climb_m_s / flyer.speed_m_s if flyer.max_climb_m_s > 0 else math.inf
