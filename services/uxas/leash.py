"""LoiterLeash: a vehicle asked to fly a heading loiters on the safe route there, a leash length
ahead.

SafeHeadingAction -> RoutePlanRequest to the point that far ahead -> RoutePlanResponse ->
VehicleActionCommand with a loiter on the route: around its farthest point where the whole disc, not
only its centre, respects the zones of the action's region (proved kernels decide). Without a route
or such a point it loiters at its position, and a ServiceStatus gives the reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import radians, tan
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.routing.loiter_discs import broken_by
from cratous.core.routing.visibility import name_of
from cratous.services.bus import Envelope
from cratous.services.loading.polygons import hard_zones
from cratous.services.pipeline.contexts import Contexts, reasons_of
from cratous.services.pipeline.status import status
from cratous.spec.errors import CratousError
from cratous.spec.mission import Position

ACTION = "uxas.messages.uxnative.SafeHeadingAction"
ROUTES_FROM = 2**61
"""First id of its route requests, distinct from those of aggregator and tasks."""
GRAVITY_M_S2 = 9.80665


class Leash(NamedTuple):
    """State: the vehicle's configuration and state, pending requests, and the action in progress."""

    configuration: Any = None
    state: Any = None
    asked: int = 0
    action: Any = None


Step = tuple[Leash, Iterable[Any]]


class LoiterLeash:
    """Leash for one vehicle."""

    subscribes: tuple[str, ...] = (
        "afrl.cmasi.EntityConfiguration",
        "afrl.cmasi.EntityState",
        "uxas.messages.route.RoutePlanResponse",
        ACTION,
    )

    def __init__(
        self, name: str, contexts: Contexts, vehicle: int, lead_m: float | None, buffer_m: float
    ) -> None:
        """lead_m: leash length, None: from the action; buffer_m: added to the turn radius."""
        self.name, self._contexts, self._vehicle = name, contexts, vehicle
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
        """Process a route response; only the answer to the newest request counts."""
        if state.action is None or body.ResponseID != ROUTES_FROM + state.asked:
            return state, ()
        action, plan = state.action, next(iter(body.RouteResponses), None)
        radius = action.LoiterRadius or self._radius(state.configuration)
        here, points = state.state.Location, []
        if plan is not None and plan.RouteCost >= 0:
            points = [here.copy(Latitude=w.Latitude, Longitude=w.Longitude) for w in plan.Waypoints]
        places = [
            point.copy(Altitude=action.Altitude, AltitudeType=action.AltitudeType)
            if action.UseAltitude
            else point
            for point in (*reversed(points), here)
        ]
        place, why = self._room(action.OperatingRegion, places, radius)
        out: list[Any] = []
        if not points:
            why = [p.Value for p in plan.RouteError] if plan is not None else []
            why = why or ["there is no route in that direction"]
        if why:
            told = [("VehicleID", str(self._vehicle)), *(("reason", text) for text in why)]
            out.append(status(0, "Warning", told))
        loiter = lmcp.new(
            "LoiterAction",
            LoiterType="Circular",
            Radius=radius,
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
        return state._replace(action=None), [*out, command]

    def _room(self, region: int, places: list[Any], radius_m: float) -> tuple[Any, list[str]]:
        """The first place with room to loiter; if there is none, the last one and the reasons."""
        try:
            known = self._contexts.for_routes(region, self._vehicle)
            zones = hard_zones(known.mission.zones)
            bad = None
            for k, place in enumerate(places):
                centre = Position(*known.pose(place, 0.0, "loiter", f"place {k}")[:3])
                bad = broken_by(centre, radius_m, zones)
                if bad is None:
                    return place, []
        except CratousError as error:
            return places[-1], list(reasons_of(error))
        assert bad is not None
        text = f"nowhere on the way is room for a loiter of {radius_m:.0f} m"
        return places[-1], [f"{text}: where it is, it breaks {name_of(bad)}"]

    def _speed(self, configuration: Any) -> float:
        return 0.0 if configuration is None else float(configuration.NominalSpeed)

    def _radius(self, configuration: Any) -> float:
        """Minimum turn radius at nominal speed, plus the buffer."""
        profile = getattr(configuration, "NominalFlightProfile", None)
        bank = profile.MaxBankAngle if profile is not None else 0.0
        if not bank:
            return self._buffer_m
        tightest = self._speed(configuration) ** 2 / (GRAVITY_M_S2 * tan(radians(bank)))
        return tightest + self._buffer_m
