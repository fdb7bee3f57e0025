"""Tasks that keep to what moves, when nobody tells of it any more, or tells what is no state."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import ENTITY, aircraft, escort, escorted, moving, refused
from pipeline_tools import Rig, place, request, vehicle
from rendezvous_tools import coming, sent_on, waiting

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.services.following import service
from cratous.services.following.motion import Motion
from cratous.services.following.task_parameters import ROUTE_MOST


def test_what_nobody_told_of_for_a_while_was_not_kept_to(tmp_path: Path) -> None:
    rig, state = escorted(tmp_path)
    entity = moving(1.0)[1]
    for time_ms in (2000, 3000, 100_000, 101_000, 102_000):
        rig.tell(entity.copy(Time=time_ms), state.copy(Time=time_ms))
    assert not rig.got("TaskComplete"), "both were silent from 3 s to 100 s"
    # a state from the future is no newer for ever
    rig.tell(entity.copy(Time=10**9))
    for time_ms in range(103_000, 130_000, 1000):
        rig.tell(state.copy(Time=time_ms))
    assert not rig.got("TaskComplete")
    for time_ms in range(130_000, 141_000, 1000):
        rig.tell(entity.copy(Time=time_ms), state.copy(Time=time_ms))
    (complete,) = rig.got("TaskComplete")
    assert complete.TimeTaskCompleted == 140_000


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (None, "an entity of which no message has told"),
        ({"Groundspeed": math.nan}, "expected finite numbers, at most 1000 m/s; got nan, 0"),
        ({"Groundspeed": 5.0, "Course": math.inf}, "Groundspeed, Course"),
        ({"Groundspeed": 1e7}, "got 1e+07, 0"),
        ({"Location": place(math.nan)}, "not a place"),
    ],
)
def test_an_entity_that_vanishes_is_said_once_and_nobody_keeps_to_it(
    tmp_path: Path, bad: dict[str, Any] | None, reason: str
) -> None:
    rig, state = escorted(tmp_path)
    entity, told = moving(1.0)[1], len(rig.said)
    rig.tell(entity.copy(Time=2000), state.copy(Time=2000))
    if bad is None:
        rig.tell(lmcp.new("RemoveEntities", EntityList=[ENTITY]))
    commands = len(rig.got("VehicleActionCommand"))
    for time_ms in range(3000, 20_000, 1000):
        rig.tell(*[] if bad is None else [entity.copy(Time=time_ms, **bad)])
        rig.tell(state.copy(Time=time_ms))
    (said,) = [text for text in rig.reasons("Warning") if "vehicle 1 does not follow" in text]
    assert reason in said
    assert len(rig.got("VehicleActionCommand")) == commands
    assert not [line for line in rig.said[told:] if "fails" in line], rig.said[told:]
    for time_ms in range(20_000, 31_000, 1000):
        rig.tell(entity.copy(Time=time_ms), state.copy(Time=time_ms))
    (complete,) = rig.got("TaskComplete")
    assert complete.TimeTaskCompleted == 30_000, "ten seconds from where it is told of again"


def test_a_task_whose_entity_moves_in_no_direction_is_refused(tmp_path: Path) -> None:
    configuration, state = moving(1.0)
    said = refused(tmp_path, escort(), configuration, state.copy(Heading=math.inf))
    assert any("u, Heading: a state without a velocity" in text for text in said), said


def test_nobody_keeps_to_himself(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), escort(SupportedEntityID=1), request(5))
    assert not rig.got("TaskPlanOptions")[0].Options
    assert any("the task keeps to this very one" in text for text in rig.reasons("Warning"))
    rig.tell(*vehicle(2, 0.01), request(5, vehicles=(1, 2)))
    (option,) = rig.got("TaskPlanOptions")[1].Options
    assert option.EligibleEntities == [2]


def test_what_is_not_used_of_an_escort_is_said(tmp_path: Path) -> None:
    assert refused(tmp_path / "a", escort(RouteID=7), *moving()) == [
        "RouteID 7 of task 5 is not used: no such line was told of; the entity goes along PrescribedWaypoints, "
        "or straight on"
    ]
    assert refused(tmp_path / "b", escort(), *moving()) == []


def test_a_way_of_too_many_places_is_refused_and_not_cut(tmp_path: Path) -> None:
    way = [lmcp.new("Waypoint", Number=k, Latitude=0.03) for k in range(ROUTE_MOST + 1)]
    (said,) = refused(tmp_path / "a", escort(PrescribedWaypoints=way), *moving())
    assert "number of PrescribedWaypoints" in said
    assert f"expected 0 to {ROUTE_MOST}; got {ROUTE_MOST + 1}" in said
    assert refused(tmp_path / "b", escort(PrescribedWaypoints=way[1:]), *moving()) == []


@pytest.mark.parametrize("of", [7, 0], ids=["line", "plan"])
def test_a_line_or_a_plan_of_too_many_places_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, of: int
) -> None:
    monkeypatch.setattr(service, "TOLD_MOST", 2)
    way = [lmcp.new("Waypoint", Number=k, Latitude=0.03 + k) for k in range(3)]
    plan = lmcp.new("MissionCommand", VehicleID=ENTITY, WaypointList=way)
    told = (
        lmcp.new("LineOfInterest", LineID=7, Line=[place(0.02), place(0.03), place(0.1)]),
        lmcp.new("AutomationResponse", MissionCommandList=[plan]),
    )
    (said,) = refused(tmp_path, escort(RouteID=of), *moving(), *told)
    assert "route of task 5: number of its places: out of range; expected 0 to 2; got 3" in said


def test_who_has_still_to_enter_his_route_is_escorted_behind_from_where_he_comes() -> None:
    """He flies north at 10 m/s, 100 m short of a route that leads on to the north and then east."""
    route = (Vec2(0.0, 0.0), Vec2(100.0, 0.0), Vec2(100.0, 100.0))
    comes = Motion(Vec2(-100.0, 0.0), Vec2(10.0, 0.0), 0, route)
    assert comes.ahead(-50.0) == Vec2(-150.0, 0.0)
    assert comes.ahead(250.0) == Vec2(100.0, 50.0)
    on_it = comes._replace(at=Vec2(100.0, 20.0))
    assert [on_it.ahead(far_m) for far_m in (-70.0, -500.0, 500.0)] == [
        Vec2(50.0, 0.0),
        route[0],
        route[-1],
    ]
    assert comes._replace(route=route[1:2]).ahead(-50.0) == Vec2(-150.0, 0.0)


def test_the_plan_of_an_entity_that_is_removed_is_not_its_route_when_it_is_told_of_again(
    tmp_path: Path,
) -> None:
    ends = []
    for gone in ([], [ENTITY]):
        folder = tmp_path / str(len(gone))
        folder.mkdir()
        rig = Rig(folder)
        ways = [lmcp.new("Waypoint", Number=k, Latitude=0.03 + k, Longitude=0.002) for k in (0, 1)]
        plan = lmcp.new("MissionCommand", VehicleID=ENTITY, WaypointList=ways)
        rig.tell(*aircraft(1, 0.0), *moving(5.0, course=90.0))
        rig.tell(lmcp.new("AutomationResponse", MissionCommandList=[plan]))
        rig.tell(lmcp.new("RemoveEntities", EntityList=gone), *moving(5.0, course=90.0))
        rig.tell(escort(), request(5))
        ends.append(rig.got("TaskPlanOptions")[0].Options[0].EndLocation)
    assert ends[1].Longitude > ends[0].Longitude + 0.005
    assert ends[1].Latitude < ends[0].Latitude - 0.005


def test_who_is_hardly_faster_and_does_not_come_up_is_not_offered(tmp_path: Path) -> None:
    said = refused(tmp_path, escort(), *moving(19.9999))[-1]
    assert said.endswith(f"it would not come up with entity {ENTITY}")


@pytest.mark.usefixtures("straight_run_ins")
@pytest.mark.shows("Task services", "RemoveTasks")
def test_who_circles_for_a_task_that_is_removed_is_sent_on(tmp_path: Path) -> None:
    rig, state = escorted(tmp_path)
    rig.tell(state.copy(Time=2000), lmcp.new("RemoveTasks", TaskList=[5, 6]))
    assert rig.reasons("Warning") == ["task 5 ends undone: it was removed"]
    assert sent_on(rig) == 1
    rig, states = coming(tmp_path)
    waiting(rig, states[0])
    assert sent_on(rig) == 0
    rig.tell(lmcp.new("RemoveTasks", TaskList=[5]))
    assert sent_on(rig) == 1
    assert "task 5 ends undone: it was removed" in rig.reasons("Warning")
