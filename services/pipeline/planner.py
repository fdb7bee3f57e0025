"""RoutePlannerVisibilityService: RoutePlanRequest -> RoutePlanResponse, costs or waypoints.

For any known vehicle, any places, any known operating region. A route that was not found has the cost -1 and
its reason in RouteError; every request is answered, to the requesting service. After an OwnRoutePlanner
message that another planner answers requests for waypoints, this one answers those for costs only. Routes are
those of `services.planning`: proved kernels check each leg against the zones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import atan2, dist
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope, Send, unicast
from cratous.services.pipeline.contexts import Contexts, reasons_of
from cratous.services.pipeline.coordinates import RequestPlaces, Way
from cratous.services.pipeline.ground import ROADS, is_ground
from cratous.services.planning.options import flight_ms
from cratous.services.planning.performance_classes import flyer_of
from cratous.spec.errors import CratousError
from cratous.spec.mission import Position

NAME = "RoutePlannerVisibilityService"
OWN_PLANNER = "cratous.OwnRoutePlanner"


class RoutePlannerVisibilityService:
    """Routes for one vehicle at a time. State: whether it also answers requests for waypoints."""

    name = NAME
    subscribes: tuple[str, ...] = (
        "uxas.messages.route.RoutePlanRequest",
        "AircraftPathPlanner",
        OWN_PLANNER,
    )
    knows = ("EntityConfiguration", "EntityState", "KeepInZone", "KeepOutZone", "OperatingRegion")

    def __init__(self, contexts: Contexts, used: bool = True) -> None:
        """used: whether it answers requests for waypoints until an OwnRoutePlanner message says otherwise."""
        self._contexts, self._used = contexts, used

    def start(self) -> bool:
        return self._used

    def handle(self, used: bool, envelope: Envelope, now_ms: int) -> tuple[bool, Iterable[Any]]:
        body = envelope.body
        if envelope.topic == OWN_PLANNER:
            return body.Plans, ()
        if not (used or body.IsCostOnlyRequest):
            return used, ()
        if is_ground(self._contexts.world, body.VehicleID):
            return used, self._driven(envelope)
        plans = plans_of(self._contexts, body, body.RouteRequests)
        return used, [answered(envelope, plans)]

    def _driven(self, asked: Envelope) -> list[Any]:
        """A ground vehicle's routes are planned along roads by a service of their own; without it there is
        none.
        """
        if self._contexts.source.asks(ROADS):
            return []
        why = f"vehicle {asked.body.VehicleID} drives, and no {ROADS} is here"
        return [answered(asked, [refused(c.RouteID, (why,)) for c in asked.body.RouteRequests])]


class RoutePlannerService(RoutePlannerVisibilityService):
    """The planner of older configurations: the same routes, without settings."""

    name = "RoutePlannerService"


def answered(asked: Envelope, plans: list[Any]) -> Any:
    """The RoutePlanResponse to a request, addressed to the requesting service as the original does."""
    return back(asked, _answer(asked.body, plans))


def _answer(request: Any, plans: list[Any]) -> Any:
    return lmcp.new(
        "RoutePlanResponse",
        ResponseID=request.RequestID,
        AssociatedTaskID=request.AssociatedTaskID,
        VehicleID=request.VehicleID,
        OperatingRegion=request.OperatingRegion,
        RouteResponses=plans,
    )


def straight_costs(contexts: Contexts, request: Any) -> Any:
    """The RoutePlanResponse with the costs of straight lines, obstacles ignored."""
    try:
        places, ways = _ways(contexts, request, request.RouteRequests)
        speed = places.mission.vehicle(request.VehicleID).speed_m_s
    except CratousError as error:
        plans = [refused(c.RouteID, reasons_of(error)) for c in request.RouteRequests]
        return _answer(request, plans)
    plans = [
        lmcp.new(
            "RoutePlan",
            RouteID=constraint.RouteID,
            RouteCost=flight_ms(dist(way.start[:2], way.end[:2]), speed),
        )
        for constraint, way in zip(request.RouteRequests, ways, strict=True)
    ]
    return _answer(request, plans)


def back(asked: Envelope, answer: Any) -> Any:
    """An answer addressed to the requesting service; broadcast if that is not identified."""
    if not asked.service_id:
        return answer
    return Send(answer, unicast(asked.entity_id, asked.service_id))


def plans_of(contexts: Contexts, request: Any, constraints: Sequence[Any]) -> list[Any]:
    """A RoutePlan for each of some RouteConstraints of a request; one without a route carries the reason."""
    try:
        return _plans(contexts, request, constraints)
    except CratousError as error:
        return [refused(c.RouteID, reasons_of(error)) for c in constraints]


def _plans(contexts: Contexts, request: Any, constraints: Sequence[Any]) -> list[Any]:
    places, ways = _ways(contexts, request, constraints)
    routes, plans = places.routes_of(ways), list[Any]()
    vehicle = [v.id for v in places.mission.vehicles].index(request.VehicleID)
    if request.IsCostOnlyRequest:  # all at once, which is faster
        routes.prepare(vehicle, [(k, k) for k in range(len(ways))])
    for k, constraint in enumerate(constraints):
        cost = routes.travel_ms(vehicle, k, k)
        if cost is None:
            reason = routes.route(vehicle, k, k).reason
            plans.append(refused(constraint.RouteID, (reason,)))
            continue
        plan = lmcp.new("RoutePlan", RouteID=constraint.RouteID, RouteCost=cost)
        if not request.IsCostOnlyRequest:
            path = routes.route(vehicle, k, k).points
            plan.Waypoints = _waypoints(contexts, places, request.VehicleID, path)
        plans.append(plan)
    return plans


def asked_way(contexts: Contexts, request: Any, constraint: Any) -> tuple[RequestPlaces, Way]:
    """The ends of the route that a constraint requests, and the places of its frame; BadInput if unknown."""
    places, (way,) = _ways(contexts, request, (constraint,))
    return places, way


def led_over(
    contexts: Contexts, request: Any, constraint: Any, given: Sequence[tuple[float, float, float]]
) -> tuple[Any, str]:
    """The RoutePlan through the points of another planner's route (latitude, longitude [deg], altitude [m]),
    with its legs checked as those of any route; or None and the reason.
    """
    try:
        places, way = asked_way(contexts, request, constraint)
        mission = places.mission
        vehicle = [v.id for v in mission.vehicles].index(request.VehicleID)
        points = [Position(*places.projection.to_local(lat, lon), alt) for lat, lon, alt in given]
        found = places.routes_of((way,)).over(vehicle, 0, 0, points)
    except CratousError as error:
        return None, "; ".join(reasons_of(error))
    if not found.points:
        return None, found.reason
    speed = flyer_of(mission.vehicle(request.VehicleID)).speed_m_s
    cost = flight_ms(found.length_m, speed)
    waypoints = _waypoints(contexts, places, request.VehicleID, found.points)
    plan = lmcp.new("RoutePlan", RouteID=constraint.RouteID, RouteCost=cost, Waypoints=waypoints)
    return plan, ""


def _ways(
    contexts: Contexts, request: Any, constraints: Sequence[Any]
) -> tuple[RequestPlaces, list[Way]]:
    places = contexts.for_routes(request.OperatingRegion, request.VehicleID)
    cruise_m = places.mission.vehicle(request.VehicleID).position.alt_m
    return places, [_way(places, constraint, cruise_m) for constraint in constraints]


def _waypoints(
    contexts: Contexts, places: RequestPlaces, vehicle_id: int, path: Sequence[Position]
) -> list[Any]:
    vehicle = places.mission.vehicle(vehicle_id)
    points = places.spaced(path, flyer_of(vehicle).radius_m, contexts.source.outside)
    return places.waypoints(points, 1, vehicle.speed_m_s, ())


def _way(places: RequestPlaces, constraint: Any, cruise_m: float) -> Way:
    """The ends of a requested route; a heading that is not requested is that of the straight line.

    An altitude of 0 that was not sent from here counts as unspecified, as in the original's tasks: the
    start's altitude applies, or cruise_m.
    """
    where, asked = f"route {constraint.RouteID}", constraint
    start = places.pose(asked.StartLocation, asked.StartHeading, where, "StartLocation")
    end = places.pose(asked.EndLocation, asked.EndHeading, where, "EndLocation")
    if start.alt_m == 0 and places.exact(asked.StartLocation, asked.StartHeading) is None:
        start = start._replace(alt_m=cruise_m)
    if end.alt_m == 0 and places.exact(asked.EndLocation, asked.EndHeading) is None:
        end = end._replace(alt_m=start.alt_m)
    if asked.UseStartHeading and asked.UseEndHeading:
        return Way(start, end)
    straight = atan2(end.east_m - start.east_m, end.north_m - start.north_m)
    if not asked.UseStartHeading:
        start = start._replace(heading_rad=straight)
    if not asked.UseEndHeading:
        end = end._replace(heading_rad=straight)
    return Way(start, end)


def refused(route: int, reasons: Iterable[str]) -> Any:
    """The RoutePlan for a route that does not exist, with the reasons."""
    why = [lmcp.new("KeyValuePair", Key="reason", Value=text) for text in reasons]
    return lmcp.new("RoutePlan", RouteID=route, RouteCost=-1, RouteError=why)
