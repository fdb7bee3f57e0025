"""RoutePlannerVisibilityService: RoutePlanRequest -> RoutePlanResponse, costs or waypoints.

Any vehicle that is known, any places, any operating region that is known. A route that was not
found has the cost -1 and its reason in RouteError; every request is answered, to the service that
has asked. Routes are those of
`services.planning`: each leg is held against the zones by proved kernels.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope, Send, unicast
from cratous.services.pipeline.contexts import Contexts, reasons_of
from cratous.services.pipeline.places import RequestPlaces, Way
from cratous.services.planning.flyers import flyer_of
from cratous.spec.errors import CratousError

NAME = "RoutePlannerVisibilityService"


class RoutePlannerVisibilityService:
    """Routes for one vehicle at a time."""

    name = NAME
    subscribes: tuple[str, ...] = ("uxas.messages.route.RoutePlanRequest", "AircraftPathPlanner")
    knows = ("EntityConfiguration", "EntityState", "KeepInZone", "KeepOutZone", "OperatingRegion")

    def __init__(self, contexts: Contexts) -> None:
        self._contexts = contexts

    def start(self) -> None:
        return None

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        body = envelope.body
        try:
            plans = self._plans(body)
        except CratousError as error:
            plans = [_refused(c.RouteID, reasons_of(error)) for c in body.RouteRequests]
        answer = lmcp.new(
            "RoutePlanResponse",
            ResponseID=body.RequestID,
            AssociatedTaskID=body.AssociatedTaskID,
            VehicleID=body.VehicleID,
            OperatingRegion=body.OperatingRegion,
            RouteResponses=plans,
        )
        if not envelope.service_id:
            return None, [answer]
        # as the original has it: to the service that has asked
        return None, [Send(answer, unicast(envelope.entity_id, envelope.service_id))]

    def _plans(self, request: Any) -> list[Any]:
        places = self._contexts.for_routes(request.OperatingRegion, request.VehicleID)
        mission, plans = places.mission, list[Any]()
        cruise_m = mission.vehicle(request.VehicleID).position.alt_m
        ways = [_way(places, constraint, cruise_m) for constraint in request.RouteRequests]
        routes = places.routes_of(ways)
        vehicle = [v.id for v in mission.vehicles].index(request.VehicleID)
        if request.IsCostOnlyRequest:  # all at once, which is faster
            routes.prepare(vehicle, [(k, k) for k in range(len(ways))])
        for k, constraint in enumerate(request.RouteRequests):
            cost = routes.travel_ms(vehicle, k, k)
            if cost is None:
                reason = routes.route(vehicle, k, k).reason
                plans.append(_refused(constraint.RouteID, (reason,)))
                continue
            plan = lmcp.new("RoutePlan", RouteID=constraint.RouteID, RouteCost=cost)
            if not request.IsCostOnlyRequest:
                speed = mission.vehicle(request.VehicleID).speed_m_s
                radius_m = flyer_of(mission.vehicle(request.VehicleID)).radius_m
                path = routes.route(vehicle, k, k).points
                points = places.spaced(path, radius_m, self._contexts.source.outside)
                plan.Waypoints = places.waypoints(points, 1, speed, ())
            plans.append(plan)
        return plans


def _way(places: RequestPlaces, constraint: Any, cruise_m: float) -> Way:
    """Where a heading is not asked for, it is that of the straight way.

    An altitude of 0 that was not sent from here says nothing, as the original's tasks have it: the
    start's holds, or cruise_m.
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


def _refused(route: int, reasons: Iterable[str]) -> Any:
    why = [lmcp.new("KeyValuePair", Key="reason", Value=text) for text in reasons]
    return lmcp.new("RoutePlan", RouteID=route, RouteCost=-1, RouteError=why)
