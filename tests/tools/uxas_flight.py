"""`cratous uxas` and `cratous sim` in one thread and in virtual time: what was flown, and what was seen of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from uxas_tools import process

from cratous.core.geofence.distance import edge_distance
from cratous.core.kernel import Vec2
from cratous.services.bus import Envelope
from cratous.services.mission.sensor import sees
from cratous.services.simulator.world import Event, World
from cratous.services.uxas.manager import startup

COMMANDS = ("afrl.cmasi.MissionCommand", "afrl.cmasi.VehicleActionCommand")
EARTH_M = 6_378_137.0
CLOSE_M = 2_000.0


class Flight(NamedTuple):
    """All messages in the order of the bus, and when each came [s]; states of the vehicles among them."""

    told: list[tuple[float, Envelope]]

    def of(self, kind: str) -> list[Any]:
        """The bodies of a type."""
        return [e.body for _, e in self.told if e.topic.rpartition(".")[2] == kind]

    def states(self, vehicle: int) -> list[Any]:
        """The states of a vehicle, twice a second."""
        return [body for body in self.of("AirVehicleState") if vehicle == body.ID]

    def command(self, vehicle: int) -> Any:
        """The last plan for a vehicle."""
        commands = self.of("AutomationResponse")[-1].MissionCommandList
        return next(c for c in commands if vehicle == c.VehicleID)


def fly(
    cfg: Path,
    events: Iterable[Event],
    seconds: float,
    said: Sequence[Any] = (),
    heard: tuple[str, ...] = COMMANDS,
) -> Flight:
    """A configuration without bridges beside a scenario; said: (time [s], message) of a client; heard: what
    the simulator is told."""
    flight, orders, later = Flight([]), list[Any](), sorted(said, key=lambda pair: pair[0])
    with process(cfg, virtual=True)[0] as one:
        world = World(events, seconds)

        def tap(envelope: Envelope) -> None:
            flight.told.append((world.time_s, envelope))
            if envelope.topic in heard:
                orders.append(envelope.body)

        one.bus.tap(tap)
        startup(one.bus)
        while not world.over:
            for body in world.tick():
                one.bus.publish(body, "simulator")
            while later and later[0][0] <= world.time_s:
                one.bus.publish(later.pop(0)[1], "client")
            one.bus.run_until(int(world.time_s * 1000))
            for order in orders:
                world.receive(order)
            orders.clear()
    return flight


def local(places: Iterable[Any], origin: Any) -> list[Vec2]:
    """Places (anything with Latitude and Longitude) as north, east of one of them [m]."""
    scale = math.radians(1) * EARTH_M
    east = scale * math.cos(math.radians(origin.Latitude))
    return [
        Vec2(scale * (p.Latitude - origin.Latitude), east * (p.Longitude - origin.Longitude))
        for p in places
    ]


def across_m(places: Sequence[Vec2], path: Sequence[Vec2]) -> list[float]:
    """How far each place is from a polyline [m]."""
    return [
        math.sqrt(min(r.num / r.den for r in (edge_distance(p, *leg) for leg in legs)))
        for legs in [[(a, b) for a, b in itertools.pairwise(path) if a != b]]
        for p in places
    ]


def share_seen(line: Sequence[Any], states: Iterable[Any], step_m: float = 50.0) -> float:
    """The share of a line's places, step_m apart, that lie in a footprint of one of the states.

    A footprint of which a corner is farther than CLOSE_M from the aircraft does not count.
    """
    bends, places = local(line, line[0]), list[Vec2]()
    for a, b in itertools.pairwise(bends):
        count = math.ceil(math.dist(a, b) / step_m)
        places += [
            Vec2(a.x + k / count * (b.x - a.x), a.y + k / count * (b.y - a.y)) for k in range(count)
        ]
    places.append(bends[-1])
    left = set(range(len(places)))
    for state in states:
        for load in state.PayloadStateList:
            if type(load).__name__ == "CameraState":
                here, *corners = local([state.Location, *load.Footprint], line[0])
                if max((math.dist(here, at) for at in corners), default=math.inf) > CLOSE_M:
                    continue
                quad = tuple(tuple(p) for p in corners)
                left -= {k for k in left if sees(quad, places[k])}
    return 1 - len(left) / len(places)
