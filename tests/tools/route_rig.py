"""The service that has routes planned by ICAROUS beside UxAS's own planner, with vehicles and a zone on the way."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from icarous_rig import Fake
from pipeline_tools import PIPELINE
from uxas_tools import process, until, write_cfg

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.flight.dynamics import Limits
from cratous.services.mission.frames import Projection
from cratous.services.uxas.frame import Clock
from cratous.spec.mission import Frame, Position, Zone, ZoneKind

SERVICE, PLANNER = "IcarousCommunicationService", "RoutePlannerVisibilityService"
AGGREGATOR = "RouteAggregatorService"
PLANE = Projection(Frame(45.0, -121.0))
BLOCK = ((800.0, -600.0), (800.0, 600.0), (1400.0, 600.0), (1400.0, -600.0))
LIMITS = Limits(15.0, 33.0, 0.52, 5.0)
ROUND = ((0.0, 0.0), (600.0, 900.0), (1600.0, 900.0), (3000.0, 0.0))
Point = tuple[float, float]
LONG = 'RouteTimeout_s="60"'


def place(point: Point) -> Any:
    lat, lon = PLANE.to_geodetic(*point)
    return lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=300.0)


def vehicle(number: int) -> list[Any]:
    profile = lmcp.new("FlightProfile", Airspeed=22.0, MaxBankAngle=30.0, VerticalSpeed=3.0)
    configuration = lmcp.new(
        "AirVehicleConfiguration", ID=number, NominalSpeed=22.0, NominalAltitude=300.0,
        NominalAltitudeType="MSL", MinimumSpeed=15.0, MaximumSpeed=33.0,
        NominalFlightProfile=profile,
    )  # fmt: skip
    return [configuration, lmcp.new("AirVehicleState", ID=number, Location=place((0.0, 0.0)))]


def block() -> Any:
    boundary = lmcp.new("Polygon", BoundaryPoints=[place(corner) for corner in BLOCK])
    return lmcp.new(
        "KeepOutZone", ZoneID=1, MaxAltitude=500.0, MaxAltitudeType="MSL", MinAltitudeType="MSL",
        Boundary=boundary,
    )  # fmt: skip


def request(*ends: Point, number: int = 7, vehicle_id: int = 1, costs: bool = False) -> Any:
    ways = [
        lmcp.new(
            "RouteConstraints", RouteID=10 + k, StartLocation=place((0.0, 0.0)),
            EndLocation=place(end),
        )
        for k, end in enumerate(ends)
    ]  # fmt: skip
    return lmcp.new(
        "RoutePlanRequest", RequestID=number, VehicleID=vehicle_id, OperatingRegion=5,
        RouteRequests=ways, IsCostOnlyRequest=costs,
    )  # fmt: skip


class Rig:
    """The service beside UxAS's own planner, vehicles, a zone on the way, and instances that do as they are told."""

    def __init__(
        self,
        folder: Path,
        opened: list[Any],
        more: str = "",
        planner: str = "",
        whole: bool = False,
        clock: Clock | None = None,
    ) -> None:
        more = more or 'NumberOfUAVs="2" RoutePlannerUsed="1" RouteTimeout_s="60"'
        if "Dialect" not in more:  # the fakes have no keys
            more += ' Dialect="cratous"'
        text = f'<Service Type="{PLANNER}" {planner}/>'
        text += f'<Service Type="{AGGREGATOR}" UseICAROUSRoutePlanner="true"/>'
        others = [name for name in PIPELINE if name not in (PLANNER, AGGREGATOR)]
        text += "".join(f'<Service Type="{name}"/>' for name in others) if whole else ""
        text += f'<Service Type="{SERVICE}" Address="tcp://127.0.0.1:0" {more}/>'
        self.process, self.said = process(write_cfg(folder, text), clock=clock)
        opened.append(self.process)
        self.sent: list[Any] = []
        self.process.bus.tap(self.sent.append)
        (service,) = self.process.ports
        self.port, self.routes = service.port.bound[1], service._routes
        self.opened = opened
        region = lmcp.new("OperatingRegion", ID=5, KeepOutAreas=[1])
        self.tell(block(), region, *vehicle(1), *vehicle(2))

    def tell(self, *bodies: Any) -> None:
        for body in bodies:
            self.process.bus.publish(body, "test")
        self.process.turn(0.0)

    def fake(self, hello: int | None, dialect: tp.Dialect = tp.Dialect.CRATOUS) -> Fake:
        one = Fake(self.port, hello, dialect)
        self.opened.append(one)
        self.until(lambda: one.all(tp.FenceDone) or self.tell(*vehicle(1)))
        return one

    def until(self, done: Callable[[], Any]) -> None:
        until(done, self.process, limit_s=60.0)

    def got(self, kind: str, source: str = "") -> list[Any]:
        return [
            e.body for e in self.sent
            if type(e.body).__name__ == kind and source in ("", e.source)
        ]  # fmt: skip

    def heard_late(self) -> None:
        """The late answer has come; the next one may take its time."""
        self.until(lambda: not self.routes._mute)
        assert self.said.has("route that nobody waits for")
        self.routes._wait_s = 60.0

    def answer(self) -> Any:
        """The one response to request 7."""
        self.until(lambda: self.got("RoutePlanResponse"))
        (one,) = self.got("RoutePlanResponse")
        assert one.ResponseID == 7
        return one

    def fallen(self, why: str) -> Any:
        """The response that UxAS's own planner has made, with the reason everywhere."""
        (plan,) = self.answer().RouteResponses
        assert why in " ".join(pair.Value for pair in plan.RouteError)
        told = [p.Value for s in self.got("ServiceStatus", SERVICE) for p in s.Info]
        assert any(why in text for text in told)
        assert self.said.has("planned by UxAS")
        assert obeys(plan)
        return plan


def obeys(plan: Any) -> bool:
    """The route has a cost, and its legs stay out of the zone."""
    zone = Zone(1, ZoneKind.KEEP_OUT, BLOCK, 0.0, 500.0)
    path = [Position(*PLANE.to_local(w.Latitude, w.Longitude), w.Altitude) for w in plan.Waypoints]
    return bool(plan.RouteCost > 0) and first_bad_leg(path, (zone,)) is None


def answer(asked: tp.RouteRequest, *points: Point, alt_m: float = 300.0) -> list[tp.Message]:
    number = asked.request
    between = [tp.RoutePoint(*PLANE.to_geodetic(*p), alt_m, 22.0, number) for p in points]
    return [tp.RouteStart(number), *between, tp.RouteEnd(number)]


def asked_of(rig: Rig, one: Fake, count: int = 1) -> Any:
    rig.until(lambda: len(one.all(tp.RouteRequest)) == count)
    return one.all(tp.RouteRequest)[-1]
