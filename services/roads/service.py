"""OsmPlannerService: routes along a map's roads for ground vehicles, and road crossings of a circle.

RoutePlanRequest of a ground vehicle -> RoutePlanResponse; EgressRouteRequest -> EgressRouteResponse;
RoadPointsRequest -> RoadPointsResponse. Every request is answered, to the requesting service; a route that
does not exist has the cost -1 and the reason. Routes keep the zones of their region: proved kernels check
each leg. The map does not change, so the service has no state.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.stations import in_ring
from cratous.services.bus import Envelope
from cratous.services.loading.uxas_parts import is_place
from cratous.services.mission.frames import compass
from cratous.services.pipeline.contexts import Contexts, reasons_of
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.ground import ROADS, is_ground
from cratous.services.pipeline.planner import answered, back, refused
from cratous.services.pipeline.status import status
from cratous.services.planning.performance_classes import flight_ms
from cratous.services.roads.files import RoadFiles
from cratous.services.roads.network import (
    OFF_ROAD_MOST_M,
    SAME_M,
    Clear,
    Foot,
    Network,
    length_m,
)
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission import Position

ROUTES = "uxas.messages.route.RoutePlanRequest"
EGRESS = "uxas.messages.route.EgressRouteRequest"
POINTS = "uxas.messages.route.RoadPointsRequest"
CROSSINGS_MOST = 32
"""Most places in an EgressRouteResponse, by its definition."""
RADIUS_MOST_M = 100_000.0


class OsmPlannerService:
    """Routes along roads."""

    name = ROADS
    subscribes: tuple[str, ...] = (ROUTES, "GroundPathPlanner", EGRESS, POINTS)
    knows = ("EntityConfiguration",)

    def __init__(
        self,
        contexts: Contexts,
        network: Network | None,
        lacks: str = "",
        files: RoadFiles | None = None,
    ) -> None:
        """network: of its map; None: no map, with the reason in lacks; files: output files for routes."""
        self._contexts, self._network, self._lacks = contexts, network, lacks
        self._files = files

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        kind = type(envelope.body).__name__
        if kind == "EgressRouteRequest":
            return state, self._egress(envelope)
        if kind == "RoadPointsRequest":
            return state, self._points(envelope)
        if kind == "RoutePlanRequest" and is_ground(self._contexts.world, envelope.body.VehicleID):
            return state, self._routes(envelope)
        return state, ()

    @property
    def _roads(self) -> Network:
        """The roads; NoPlan without a map."""
        if self._network is None:
            raise NoPlan((self._lacks,))
        return self._network

    def _egress(self, asked: Envelope) -> list[Any]:
        """The road crossings of the circle, with outward headings [deg]; a warning with the reason if there
        are none.
        """
        body, out = asked.body, list[Any]()
        places, headings = list[Any](), list[float]()
        try:
            for at, heading_rad in self._crossings(body):
                places.append(self._location(at))
                headings.append(compass(heading_rad))
        except CratousError as error:
            out = [_warning("EgressRouteRequest", body.RequestID, error)]
        answer = lmcp.new(
            "EgressRouteResponse",
            ResponseID=body.RequestID,
            NodeLocations=places,
            Headings=headings,
        )
        return [*out, back(asked, answer)]

    def _crossings(self, body: Any) -> Sequence[tuple[Vec2, float]]:
        middle, radius = self._place(body.StartLocation, "StartLocation"), float(body.Radius)
        if not 1.0 <= radius <= RADIUS_MOST_M:
            raise BadInput(
                "out of range", where=EGRESS, item="Radius",
                expected=f"1 to {RADIUS_MOST_M:g} m", got=f"{radius:g}",
            )  # fmt: skip
        found = self._roads.crossings(middle, radius)
        if len(found) > CROSSINGS_MOST:
            raise BadInput(
                "too many roads cross the circle", where=EGRESS, item="Radius",
                expected=f"at most {CROSSINGS_MOST} crossings", got=str(len(found)),
            )  # fmt: skip
        return found

    def _points(self, asked: Envelope) -> list[Any]:
        """The points along the shortest routes; a warning for each that does not exist."""
        body, lines, out = asked.body, list[Any](), list[Any]()
        for one in body.RoadPointsRequests:
            try:
                ends = self._feet(one.StartLocation, one.EndLocation)
                points = self._timed(partial(_way, self._roads, *ends))
            except CratousError as error:
                out.append(
                    _warning(f"RoadPointsConstraints {one.RoadPointsID}", body.RequestID, error)
                )
                continue
            line = [self._location(at, "AGL") for at in points]
            lines.append(lmcp.new("LineOfInterest", LineID=one.RoadPointsID, Line=line))
        answer = lmcp.new(
            "RoadPointsResponse", ResponseID=body.RequestID, RoadPointsResponses=lines
        )
        return [*out, back(asked, answer)]

    def _routes(self, asked: Envelope) -> list[Any]:
        """A RoutePlan for each requested route; a warning with the reasons if some are missing."""
        body, plans = asked.body, list[Any]()
        try:
            places = self._contexts.for_routes(body.OperatingRegion, body.VehicleID)
            driven = _Driven(self._roads, places)
        except CratousError as error:
            plans = [refused(c.RouteID, reasons_of(error)) for c in body.RouteRequests]
        else:
            plans = [self._plan(body, one, places, driven) for one in body.RouteRequests]
        why = dict.fromkeys(pair.Value for plan in plans for pair in plan.RouteError)
        facts = [("reason", f"vehicle {body.VehicleID}: {text}") for text in why]
        said = [status(0, "Warning", facts)] if why else []
        return [*said, answered(asked, plans)]

    def _plan(self, body: Any, one: Any, places: RequestPlaces, driven: _Driven) -> Any:
        try:
            feet = self._feet(one.StartLocation, one.EndLocation)
            path: list[Position] = []
            way = self._timed(partial(driven.way, *feet, path))
        except CratousError as error:
            return refused(one.RouteID, reasons_of(error))
        speed = places.mission.vehicle(body.VehicleID).speed_m_s
        plan = lmcp.new("RoutePlan", RouteID=one.RouteID, RouteCost=flight_ms(length_m(way), speed))
        if not body.IsCostOnlyRequest:
            plan.Waypoints = places.waypoints(path, 1, speed, ())
        return plan

    def _timed(self, search: Callable[[], tuple[Vec2, ...]]) -> tuple[Vec2, ...]:
        """The result of a search, written to files if configured."""
        began_s = time.perf_counter()
        way = search()
        if self._files is not None:
            self._files.way(self._roads, way, time.perf_counter() - began_s)
        return way

    def _feet(self, start: Any, end: Any) -> tuple[Foot, Foot]:
        return self._foot(start, "StartLocation"), self._foot(end, "EndLocation")

    def _foot(self, location: Any, item: str) -> Foot:
        """The road point nearest to a location; NoPlan if none is near."""
        foot = self._roads.foot(self._place(location, item))
        if foot is None:
            at = f"{location.Latitude:.6f}, {location.Longitude:.6f}"
            raise NoPlan((f"no road is within {OFF_ROAD_MOST_M:g} m of {item} ({at})",))
        return foot

    def _place(self, location: Any, item: str) -> Vec2:
        if location is None or not is_place(location.Latitude, location.Longitude):
            got = "none" if location is None else f"{location.Latitude:g}, {location.Longitude:g}"
            raise BadInput(
                "not a place", where=ROADS, item=item,
                expected="a latitude within ±89 and a longitude within ±180 degrees", got=got,
            )  # fmt: skip
        return self._roads.local(location.Latitude, location.Longitude)

    def _location(self, at: Vec2, kind: str = "MSL") -> Any:
        lat, lon = self._roads.projection.to_geodetic(at.x, at.y)
        return lmcp.new("Location3D", Latitude=lat, Longitude=lon, AltitudeType=kind)


class _Driven:
    """Routes along roads in the zones of one request."""

    def __init__(self, roads: Network, places: RequestPlaces) -> None:
        self._roads, self._places = roads, places
        self._clear: dict[tuple[Vec2, Vec2], bool] = {}

    def way(self, start: Foot, end: Foot, path: list[Position]) -> tuple[Vec2, ...]:
        """The route in the map's plane; also appended to `path` in the request's frame. NoPlan if there is
        none.
        """
        zones = self._places.zones
        points = _way(self._roads, start, end, self._may if zones else None)
        points = _thinned((start.place, *points, end.place))
        path += self._positions(points)
        bad = first_bad_leg(path, zones)
        if bad is not None:
            raise NoPlan((f"its way to the road, or from it, breaks {name_of(bad[1])}",))
        return points

    def _may(self, p: Vec2, q: Vec2) -> bool:
        """Whether a leg keeps the zones."""
        if (p, q) not in self._clear:
            self._clear[p, q] = first_bad_leg(self._positions((p, q)), self._places.zones) is None
        return self._clear[p, q]

    def _positions(self, points: Sequence[Vec2]) -> tuple[Position, ...]:
        lats, lons = self._roads.projection.to_geodetic_many(*zip(*points, strict=True))
        norths, easts = self._places.projection.to_local_many(lats.tolist(), lons.tolist())
        alt = self._places.mission.frame.terrain_m
        return tuple(Position(float(n), float(e), alt) for n, e in zip(norths, easts, strict=True))


def _way(roads: Network, start: Foot, end: Foot, clear: Clear | None = None) -> tuple[Vec2, ...]:
    found = roads.way(start, end, clear)
    if not found:
        text = (
            "no road leads there" if clear is None else "no road leads there that keeps the zones"
        )
        raise NoPlan((text,))
    return found


def _thinned(points: Sequence[Vec2]) -> tuple[Vec2, ...]:
    """The points without those within SAME_M of the one before; the ends stay."""
    kept = [points[0]]
    for point in points[1:-1]:
        if not in_ring(kept[-1], point, 0.0, SAME_M):
            kept.append(point)
    if len(kept) > 1 and in_ring(kept[-1], points[-1], 0.0, SAME_M):
        kept.pop()
    return (*kept, points[-1])


def _warning(what: str, request: int, error: CratousError) -> Any:
    facts = [("reason", f"{what}: {text}") for text in reasons_of(error)]
    return status(0, "Warning", [*facts, ("Request", str(request))])
