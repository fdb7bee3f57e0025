"""LoiterLeash: a vehicle asked to go in a direction loiters on the safe way there, a leash ahead.

SafeHeadingAction -> RoutePlanRequest to the point that far ahead -> RoutePlanResponse ->
VehicleActionCommand with a loiter at the end of the route. Without a route it loiters where it is.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import radians, tan
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope

ACTION = "uxas.messages.uxnative.SafeHeadingAction"
ROUTES_FROM = 2**61
"""Ids of its route requests, apart from those of aggregator and tasks."""
GRAVITY_M_S2 = 9.80665


class Leash(NamedTuple):
    """The vehicle's configuration and state, requests so far, and the action in work."""

    configuration: Any = None
    state: Any = None
    asked: int = 0
    action: Any = None


Step = tuple[Leash, Iterable[Any]]


class LoiterLeash:
    """For one vehicle."""

    subscribes: tuple[str, ...] = (
        "afrl.cmasi.EntityConfiguration",
        "afrl.cmasi.EntityState",
        "uxas.messages.route.RoutePlanResponse",
        ACTION,
    )

    def __init__(self, name: str, vehicle: int, lead_m: float | None, buffer_m: float) -> None:
        """lead_m: how far ahead, None: as the action says; buffer_m: added to the turn radius."""
        self.name, self._vehicle = name, vehicle
        self._lead_m, self._buffer_m = lead_m, buffer_m

    def start(self) -> Leash:
        return Leash()

    def handle(self, state: Leash, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == ACTION:
            return self._ask(state, body) if body.VehicleID == self._vehicle else (state, ())
        if topic == "uxas.messages.route.RoutePlanResponse":
            return self._answered(state, body)
        if self._vehicle != body.ID:
            return state, ()
        if hasattr(body, "Location"):
            return state._replace(state=body), ()
        return state._replace(configuration=body), ()

    def _ask(self, state: Leash, action: Any) -> Step:
        here = state.state
        if here is None:
            return state, ()
        from pyproj import Geod

        lead_m = action.LeadAheadDistance if self._lead_m is None else self._lead_m
        place = here.Location
        lon, lat, _ = Geod(ellps="WGS84").fwd(
            place.Longitude, place.Latitude, action.DesiredHeading, lead_m
        )
        there = place.copy(Latitude=lat, Longitude=lon)
        way = lmcp.new(
            "RouteConstraints",
            RouteID=1,
            StartLocation=place,
            StartHeading=here.Heading,
            EndLocation=there,
            EndHeading=action.DesiredHeading,
        )
        number = state.asked + 1
        request = lmcp.new(
            "RoutePlanRequest",
            RequestID=ROUTES_FROM + number,
            VehicleID=self._vehicle,
            OperatingRegion=action.OperatingRegion,
            RouteRequests=[way],
            IsCostOnlyRequest=False,
        )
        return state._replace(asked=number, action=action), [request]

    def _answered(self, state: Leash, body: Any) -> Step:
        """Only the answer to the newest request counts."""
        if state.action is None or body.ResponseID != ROUTES_FROM + state.asked:
            return state, ()
        action, plan = state.action, next(iter(body.RouteResponses), None)
        place = state.state.Location
        if plan is not None and plan.RouteCost >= 0 and plan.Waypoints:
            end = plan.Waypoints[-1]
            place = place.copy(Latitude=end.Latitude, Longitude=end.Longitude)
        if action.UseAltitude:
            place = place.copy(Altitude=action.Altitude, AltitudeType=action.AltitudeType)
        loiter = lmcp.new(
            "LoiterAction",
            LoiterType="Circular",
            Radius=action.LoiterRadius or self._radius(state.configuration),
            Duration=-1,
            Airspeed=action.Speed if action.UseSpeed else self._speed(state.configuration),
            Location=place,
            AssociatedTaskList=list(action.AssociatedTaskList),
        )
        command = lmcp.new(
            "VehicleActionCommand",
            CommandID=state.asked,
            VehicleID=self._vehicle,
            VehicleActionList=[loiter],
        )
        return state._replace(action=None), [command]

    def _speed(self, configuration: Any) -> float:
        return 0.0 if configuration is None else float(configuration.NominalSpeed)

    def _radius(self, configuration: Any) -> float:
        """The tightest turn at nominal speed, and the buffer."""
        profile = getattr(configuration, "NominalFlightProfile", None)
        bank = profile.MaxBankAngle if profile is not None else 0.0
        if not bank:
            return self._buffer_m
        tightest = self._speed(configuration) ** 2 / (GRAVITY_M_S2 * tan(radians(bank)))
        return tightest + self._buffer_m
