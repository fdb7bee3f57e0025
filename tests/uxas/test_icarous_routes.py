"""Routes that ICAROUS plans for UxAS: each answer is held against the zones, and what is none falls back."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
from icarous_tools import VOLUME
from route_rig import (
    BLOCK,
    LIMITS,
    LONG,
    PLANE,
    ROUND,
    Point,
    Rig,
    answer,
    asked_of,
    obeys,
    place,
    request,
)

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.port import Address
from cratous.bridge.text_port import TextPort
from cratous.services.icarous.state import Config
from cratous.services.icarous_communication import routes as routes_module
from cratous.services.icarous_communication.routes import MOST_POINTS
from cratous.services.icarous_program import program as program_module
from cratous.services.icarous_program.program import Program
from cratous.services.icarous_program.routes import Planner
from cratous.services.icarous_program.step import Craft, IcarousEnd
from cratous.services.pipeline import planner
from cratous.spec.mission import Daa, Zone, ZoneKind

SERVICE, PLANNER = "IcarousCommunicationService", "RoutePlannerVisibilityService"
AGGREGATOR = "RouteAggregatorService"


@pytest.mark.shows(SERVICE, "RoutePlannerUsed", "RoutePlanRequest", "RoutePlanResponse",
                   "OwnRoutePlanner", "IcarousPathPlanner")  # fmt: skip
@pytest.mark.shows(PLANNER, "OwnRoutePlanner")
def test_icarous_plans_and_the_own_planner_is_told_to_leave_it_to_it(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, opened)
    assert [body.Plans for body in rig.got("OwnRoutePlanner")] == [False]
    one, two = rig.fake(1), rig.fake(2)
    rig.tell(request((3000.0, 0.0)))
    asked = asked_of(rig, one)
    assert (asked.planner, asked.horizontal_mps, asked.track_deg) == ("ASTAR", 22.0, 0.0)
    assert PLANE.to_local(asked.end_lat_deg, asked.end_long_deg)[0] == pytest.approx(3000.0, abs=1)
    one.say(*answer(asked, *ROUND))
    (plan,) = rig.answer().RouteResponses
    assert obeys(plan)
    assert not plan.RouteError
    # it leads over the places of ICAROUS
    path = [PLANE.to_local(w.Latitude, w.Longitude) for w in plan.Waypoints]
    for place_ in ROUND:
        assert min(math.dist(place_, p) for p in path) < 120.0
    metres = sum(math.dist(p, q) for p, q in itertools.pairwise(path))
    assert plan.RouteCost == pytest.approx(1000 * metres / 22.0, rel=0.02)
    assert not two.all(tp.RouteRequest)
    # costs are UxAS's own planner's
    rig.tell(request((3000.0, 0.0), number=8, costs=True))
    assert [r.ResponseID for r in rig.got("RoutePlanResponse", PLANNER)] == [8]
    assert len(one.all(tp.RouteRequest)) == 1


def test_ways_are_asked_one_at_a_time_and_answered_together(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, opened)
    one = rig.fake(1)
    # of a vehicle without an instance here: the lowest one that is there plans
    rig.tell(request((3000.0, 0.0), (0.0, 2000.0), vehicle_id=2))
    first = asked_of(rig, one)
    one.say(*answer(first, *ROUND))
    second = asked_of(rig, one, 2)
    assert second.request != first.request
    assert not rig.got("RoutePlanResponse")
    one.say(*answer(second, (0.0, 2000.0)))
    plans = rig.answer().RouteResponses
    assert [plan.RouteID for plan in plans] == [10, 11]
    assert all(obeys(plan) and not plan.RouteError for plan in plans)
    assert rig.said.has("2 of 2 by ICAROUS")


@pytest.mark.parametrize(
    ("points", "alt_m", "why"),
    [
        ((), 300.0, "it has found no way"),
        (((0.0, 0.0), (3000.0, 0.0)), 300.0, "keep-out zone 1"),
        (((0.0, 0.0), (1000.0, 0.0), (3000.0, 0.0)), 300.0, "keep-out zone 1"),
        (((0.0, 0.0), (600.0, 900.0), (1600.0, 900.0)), 300.0, "does not end where"),
        (ROUND, 600.0, "above or below both ends"),
        (ROUND, 1e14, "above or below both ends"),
        (((0.0, 0.0),) * (MOST_POINTS + 5), 300.0, f"more than {MOST_POINTS}"),
    ],
)
def test_an_answer_that_is_no_route_falls_back_with_the_reason(
    tmp_path: Path, opened: list[Any], points: tuple[Point, ...], alt_m: float, why: str
) -> None:
    rig = Rig(tmp_path, opened)
    one = rig.fake(1)
    rig.tell(request((3000.0, 0.0)))
    one.say(*answer(asked_of(rig, one), *points, alt_m=alt_m))
    rig.fallen(why)


@pytest.mark.shows(SERVICE, "RouteTimeout_s")
def test_no_answer_a_late_one_and_one_to_another_request(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = Rig(tmp_path, opened, 'NumberOfUAVs="1" RoutePlannerUsed="1" RouteTimeout_s="30"')
    rig.tell(request((3000.0, 0.0)))
    rig.fallen("no ICAROUS is connected that answers")
    rig.sent.clear()
    one = rig.fake(1)
    rig.tell(request((3000.0, 0.0), (0.0, 2000.0)))
    (service,) = rig.process.ports
    with monkeypatch.context() as still:  # its time runs from the first look, whenever the last was
        still.setattr(service.port, "step", lambda _now_s: [])
        for later_s in (0, 29, 30):
            assert rig.routes._out
            service.pump(1e9 + later_s)
    late = asked_of(rig, one)
    plans = rig.answer().RouteResponses
    # who has not answered in time is not asked again before it has
    assert len(one.all(tp.RouteRequest)) == 1
    assert "no answer within 30 s" in plans[0].RouteError[0].Value
    assert "no ICAROUS is connected that answers" in plans[1].RouteError[0].Value
    one.say(*answer(late, *ROUND))
    rig.heard_late()
    assert len(rig.got("RoutePlanResponse")) == 1
    rig.sent.clear()
    rig.tell(request((0.0, 2000.0)))
    one.say(*answer(asked_of(rig, one, 2), (0.0, 2000.0)))
    (plan,) = rig.answer().RouteResponses
    assert plan.RouteCost > 0


@pytest.mark.parametrize("where", ["asked_way", "led_over"])
def test_what_fails_at_one_way_neither_ends_uxas_nor_stays_unanswered(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    def fails(*_: Any) -> None:
        raise MemoryError(where)

    rig = Rig(tmp_path, opened)
    one = rig.fake(1)
    monkeypatch.setattr(planner, where, fails)
    monkeypatch.setattr(planner, "plans_of", fails)
    rig.tell(request((3000.0, 0.0)))
    if where == "led_over":
        one.say(*answer(asked_of(rig, one), *ROUND))
    (plan,) = rig.answer().RouteResponses
    assert (plan.RouteID, plan.RouteCost) == (10, -1)
    assert all("MemoryError" in pair.Value for pair in plan.RouteError)


def test_wrong_numbers_lines_without_a_beginning_and_a_lost_link(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, opened)
    one = rig.fake(1)
    one.say(tp.RouteStart(1), tp.RouteEnd(1))
    rig.until(lambda: rig.said.has("route that nobody waits for"))
    rig.tell(request((3000.0, 0.0)))
    asked = asked_of(rig, one)
    one.say(*answer(tp.RouteRequest(*(0,) * 10, request=99), *ROUND))  # type: ignore[arg-type]
    rig.until(lambda: rig.said.has("route of another request"))
    one.say(*answer(asked, *ROUND)[1:])
    rig.until(lambda: rig.said.has("route without its beginning"))
    one.say(tp.RouteStart(None))
    assert not rig.got("RoutePlanResponse")
    one.close()
    rig.fallen("the connection has ended")


def test_a_late_answer_of_the_original_is_not_taken_for_the_next(
    tmp_path: Path, opened: list[Any]
) -> None:
    more = 'NumberOfUAVs="1" RoutePlannerUsed="2" RouteTimeout_s="0.2" Dialect="original"'
    rig = Rig(tmp_path, opened, more)
    one = rig.fake(None, tp.Dialect.ORIGINAL)
    rig.tell(request((3000.0, 0.0)))
    late = asked_of(rig, one)
    assert (late.planner, late.request) == ("RRT", None)
    rig.fallen("no answer within 0.2 s")
    rig.sent.clear()
    one.say(*answer(late, *ROUND))
    rig.heard_late()
    rig.tell(request((0.0, 2000.0)))
    asked_of(rig, one, 2)
    one.say(*answer(late, (0.0, 2000.0)))
    (plan,) = rig.answer().RouteResponses
    assert not plan.RouteError


@pytest.mark.shows(PLANNER, "UseThisPlanner")
@pytest.mark.shows(AGGREGATOR, "UseICAROUSRoutePlanner")
def test_the_attributes_of_planner_and_aggregator(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, opened, 'NumberOfUAVs="1"', 'UseThisPlanner="false"')
    assert rig.said.has("UseThisPlanner: routes are planned elsewhere")
    assert rig.said.has("UseICAROUSRoutePlanner: routes are planned elsewhere")
    rig.tell(request((3000.0, 0.0)), request((3000.0, 0.0), number=8, costs=True))
    assert [r.ResponseID for r in rig.got("RoutePlanResponse")] == [8]
    rig.tell(lmcp.new("OwnRoutePlanner", Plans=True), request((3000.0, 0.0), number=9))
    assert [r.ResponseID for r in rig.got("RoutePlanResponse")] == [8, 9]
    more = lmcp.new(
        "RouteRequest", RequestID=3, VehicleID=[1], OperatingRegion=5,
        RouteRequests=request((3000.0, 0.0)).RouteRequests, IsCostOnlyRequest=False,
    )  # fmt: skip
    rig.tell(more)
    sent = [e.address for e in rig.sent if e.source == AGGREGATOR]
    assert sent == ["IcarousPathPlanner"]


def test_too_many_ways_are_planned_by_the_own_planner(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(routes_module, "MOST_WAITING", 1)
    rig = Rig(tmp_path, opened)
    one = rig.fake(1)
    rig.tell(request((3000.0, 0.0), (0.0, 2000.0)))
    one.say(*answer(asked_of(rig, one), *ROUND))
    first, second = rig.answer().RouteResponses
    assert not first.RouteError
    assert "more than 1 ways wait" in second.RouteError[0].Value


@pytest.mark.parametrize("kind", routes_module.PLANNERS)
def test_what_our_icarous_answers_is_a_route(tmp_path: Path, opened: list[Any], kind: str) -> None:
    number = routes_module.PLANNERS.index(kind)
    rig = Rig(tmp_path, opened, f'NumberOfUAVs="1" RoutePlannerUsed="{number}" {LONG}')
    one = rig.fake(1)
    rig.tell(request((3000.0, 0.0)))
    asked = asked_of(rig, one)
    assert asked.planner == kind
    zone = Zone(1, ZoneKind.KEEP_OUT, BLOCK, 0.0, 500.0)
    lines, why = Planner(PLANE, LIMITS).answer(asked, (zone,))
    assert why == ""
    assert len(lines) > 4
    assert {line.request for line in lines} == {asked.request}  # type: ignore[attr-defined]
    one.say(*lines)
    (plan,) = rig.answer().RouteResponses
    assert obeys(plan)
    assert not plan.RouteError, plan.RouteError[0].Value


def test_the_way_of_a_mission_is_that_of_icarous(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, opened, f'NumberOfUAVs="1" RoutePlannerUsed="1" {LONG}', whole=True)
    one = rig.fake(1)
    task = lmcp.new("MustFlyTask", TaskID=3, Position=place((3000.0, 0.0)))
    rig.tell(task)
    rig.tell(lmcp.new("AutomationRequest", EntityList=[1], TaskList=[3], OperatingRegion=5))
    asked = asked_of(rig, one)
    north, east = PLANE.to_local(asked.end_lat_deg, asked.end_long_deg)
    one.say(*answer(asked, *ROUND[:-1], (north, east)))
    rig.until(lambda: rig.got("AutomationResponse"))
    (command,) = rig.got("AutomationResponse")[0].MissionCommandList
    path = [PLANE.to_local(w.Latitude, w.Longitude) for w in command.WaypointList]
    assert all(min(math.dist(p, q) for q in path) < 120.0 for p in ROUND)
    assert obeys(lmcp.new("RoutePlan", RouteCost=1, Waypoints=command.WaypointList))


def test_our_icarous_plans_among_the_zones_that_it_was_told(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(program_module, "_LONGEST_POLL_MS", 1)
    rig = Rig(tmp_path, opened, 'NumberOfUAVs="1" RoutePlannerUsed="1" RouteTimeout_s="60"')
    port = TextPort(Address("tcp", "127.0.0.1", rig.port, "UxAS"), server=False)
    opened.append(port)
    craft = Craft(Config(1, Daa(VOLUME), PLANE, 500), LIMITS, 60.0)
    program, said = Program(IcarousEnd(craft), port, lambda _, text: said.append(text)), list[str]()
    rig.until(lambda: (program.turn(), program.state.instance.told.zones)[1])
    rig.tell(request((3000.0, 0.0)))
    rig.until(lambda: (program.turn(), rig.got("RoutePlanResponse"))[1])
    (plan,) = rig.answer().RouteResponses
    assert obeys(plan)
    assert not plan.RouteError
    assert any("UxAS asks for a route (ASTAR): a way of 4 points" in text for text in said)
