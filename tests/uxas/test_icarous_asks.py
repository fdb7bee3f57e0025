"""An ICAROUS that asks UxAS for a way back: UxAS's own planner answers, and the handback leads onto that way."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
from route_rig import PLANE, Rig, obeys, place, vehicle

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.services.icarous_communication.proposals import MOST, WITHIN_MS
from cratous.services.uxas.frame import Clock
from cratous.spec.errors import BadInput

SERVICE = "IcarousCommunicationService"
LIVE = 'NumberOfUAVs="1" VehicleIDs="1" UseUxasRoutePlanner="true"'
BEAT_MS = 500
START = PLANE.to_geodetic(0.0, 0.0)


def wanted(north_m: float, number: int | None = 1) -> tp.RouteRequest:
    end = PLANE.to_geodetic(north_m, 0.0)
    return tp.RouteRequest("ASTAR", *START, 300.0, *end, 300.0, 0.0, 22.0, 0.0, number)


def answered(rig: Rig, one: Any, line: tp.RouteRequest) -> list[Any]:
    """The places of the answer to a request."""
    before = len(one.all(tp.RouteEnd))
    one.say(line)
    rig.until(lambda: len(one.all(tp.RouteEnd)) > before)
    assert one.all(tp.RouteEnd)[-1].request == line.request
    return [point for point in one.all(tp.RoutePoint) if point.request == line.request]


def flying(rig: Rig) -> None:
    """Vehicle 1 on its way to a place behind the zone."""
    at = place((3000.0, 0.0))
    end = lmcp.new(
        "Waypoint", Number=1, NextWaypoint=1, Latitude=at.Latitude, Longitude=at.Longitude,
        Altitude=300.0, Speed=22.0,
    )  # fmt: skip
    rig.tell(lmcp.new("MissionCommand", VehicleID=1, FirstWaypoint=1, WaypointList=[end]))
    state = vehicle(1)[1].copy(u=22.0, CurrentWaypoint=1, Time=1000)
    rig.tell(state)


@pytest.mark.shows(SERVICE, "UseUxasRoutePlanner")
def test_it_is_answered_by_uxas_and_handed_back_onto_the_answer(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, opened, LIVE)
    one = rig.fake(1)
    rig.until(lambda: one.all(tp.UxasPlans))
    flying(rig)
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.said.has("ICAROUS has it"))
    places = answered(rig, one, wanted(3000.0))
    path = [PLANE.to_local(p.lat_deg, p.long_deg) for p in places]
    assert path[-1] == pytest.approx((3000.0, 0.0), abs=1.0)
    assert max(abs(east) for _, east in path) > 600.0, "around the zone"
    one.say(tp.SetMode("PASSIVE", 2, 1))
    rig.until(lambda: rig.got("MissionCommand", SERVICE))
    (command,) = rig.got("MissionCommand", SERVICE)
    points = {w.Number: w for w in command.WaypointList}
    way, number = [], command.FirstWaypoint
    while number in points:
        way.append(points.pop(number))
        number = way[-1].NextWaypoint
    flown = [(0.0, 0.0), *(PLANE.to_local(w.Latitude, w.Longitude) for w in way)]
    assert flown[-1] == pytest.approx((3000.0, 0.0), abs=1.0)
    assert obeys(
        lmcp.new("RoutePlan", RouteCost=1, Waypoints=[vehicle(1)[1].Location, *()] and way)
    )
    legs = sum(math.dist(p, q) for p, q in itertools.pairwise(flown))
    planned = sum(math.dist(p, q) for p, q in itertools.pairwise(path))
    assert legs == pytest.approx(planned, rel=0.05)


def test_without_its_number_it_is_the_direct_way(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, opened, LIVE)
    one = rig.fake(1)
    flying(rig)
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.said.has("ICAROUS has it"))
    assert answered(rig, one, wanted(3000.0))
    one.say(tp.SetMode("PASSIVE", 2, 7))
    rig.until(lambda: rig.got("MissionCommand", SERVICE))
    (command,) = rig.got("MissionCommand", SERVICE)
    east = [PLANE.to_local(w.Latitude, w.Longitude)[1] for w in command.WaypointList]
    assert max(map(abs, east)) < 1.0
    assert rig.said.has("request 7 has no answer: it is led back by the direct way")


def test_what_cannot_be_answered_is_answered_without_a_way(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, opened, LIVE)
    one = rig.fake(1)
    flying(rig)
    assert not answered(rig, one, wanted(3000.0, 5)), "UxAS flies the vehicle"
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.said.has("ICAROUS has it"))
    assert not answered(rig, one, wanted(1000.0, 6)), "it ends in the zone"
    assert rig.said.has("request 6")
    rig.tell(lmcp.new("OwnRoutePlanner", Plans=False, Reason="test"))
    rig.until(lambda: one.all(tp.IcarousPlans))
    assert not answered(rig, one, wanted(3000.0, 7))
    rig.tell(lmcp.new("OwnRoutePlanner", Plans=True, Reason="test"))
    rig.until(lambda: len(one.all(tp.UxasPlans)) == 2)
    assert answered(rig, one, wanted(3000.0, 8))


def test_an_instance_that_asks_again_and_again_is_planned_for_no_more(
    tmp_path: Path, opened: list[Any]
) -> None:
    now_ms, numbers = 0, itertools.count(1)
    rig = Rig(tmp_path, opened, LIVE, clock=Clock(lambda: now_ms / 1000))
    one = rig.fake(1)
    flying(rig)
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.said.has("ICAROUS has it"))

    def asked(count: int) -> list[bool]:
        """Whether each of so many requests at this instant is answered by a way."""
        return [bool(answered(rig, one, wanted(3000.0, next(numbers)))) for _ in range(count)]

    def come() -> None:
        """It is now for the service, too."""
        rig.until(lambda: rig.process.bus.now_ms == now_ms)

    assert asked(MOST + 2) == [True] * MOST + [False, False]
    assert rig.said.has(f"more than {MOST} WPREQ in {WITHIN_MS / 1000:g} s")
    for _ in range(WITHIN_MS // BEAT_MS):  # it is heard at each heartbeat
        assert asked(1) == [False], now_ms
        now_ms += BEAT_MS
        one.say(tp.Heartbeat(next(numbers), now_ms / 1000))
        come()
    assert asked(1) == [False], "the first was planned for so long ago, and no longer"
    now_ms += 1
    come()
    assert asked(MOST + 1) == [True] * MOST + [False]


def test_nobody_asks_a_uxas_that_does_not_plan_live(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, opened, 'NumberOfUAVs="1"')
    one = rig.fake(1)
    one.say(wanted(3000.0))
    rig.until(lambda: rig.said.has("no UseUxasRoutePlanner"))
    assert not one.all(tp.UxasPlans)
    assert not one.all(tp.RouteStart)


def test_peers_of_other_dialects_cannot_ask(tmp_path: Path, opened: list[Any]) -> None:
    with pytest.raises(BadInput, match="peers that cannot ask UxAS"):
        Rig(tmp_path, opened, f'{LIVE} Dialect="original"')
