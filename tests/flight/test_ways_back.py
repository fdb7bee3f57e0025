"""Ways made in flight keep the zones, by the kernels of legs; where there is none, a task fails by name."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import meeting, of_type

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.polylines import Track
from cratous.services.flight import changes, interruption, remaining_path, task_transitions
from cratous.services.flight.autopilot import Follow
from cratous.services.flight.chain import Phase
from cratous.services.flight.commands import decode
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.flight.executive_state import Config, State, first_state
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.messages import Begin, Say, SetOut, Suspend, TakeBack, Tick
from cratous.services.flight.rejoining import Router
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.plan import make_plan
from cratous.services.planning.zone_exits import way_out
from cratous.spec.authority.link_end import SUSPEND, TAKE_BACK
from cratous.spec.constraint_rows import NOT_BEFORE, Row
from cratous.spec.executive import FAIL_TASK
from cratous.spec.mission import Position, Zone, ZoneKind
from cratous.spec.mission.plan import Pose


def box(kind: ZoneKind, south: float, north: float, half: float, zid: int = 4) -> Zone:
    corners = ((south, -half), (south, half), (north, half), (north, -half))
    return Zone(zid, kind, corners, 0.0, 1000.0)


CAGE = box(ZoneKind.KEEP_IN, 1000.0, 3000.0, 1000.0)
HERE = AirState(Position(2000.0, 300.0, 300.0), 0.0, 22.0, 0.0)
RADIUS_M = 80.0


def test_no_way_leads_out_of_a_cage() -> None:
    router = Router((CAGE,))
    assert router.way_to(HERE, RADIUS_M, Pose(6000.0, 0.0, 300.0, 0.0)) == ()
    inside = router.way_to(HERE, RADIUS_M, Pose(2700.0, -200.0, 300.0, 0.0))
    assert inside
    assert first_bad_leg(inside, (CAGE,)) is None


def test_a_zone_that_was_entered_is_left_for_good_and_the_others_are_kept() -> None:
    entered = box(ZoneKind.KEEP_OUT, 1900.0, 2200.0, 900.0)
    other = box(ZoneKind.KEEP_OUT, 3000.0, 3400.0, 1500.0, 5)
    router = Router((entered, other))
    way = router.way_to(HERE, RADIUS_M, Pose(5000.0, 0.0, 300.0, 0.0))
    assert first_bad_leg(way, (other,)) is None
    inside = [first_bad_leg(leg, (entered,)) is not None for leg in itertools.pairwise(way)]
    assert inside[0]
    assert inside == sorted(inside, reverse=True)
    assert not inside[-1]
    # its own zone holds the place: no way comes out of it
    assert router.way_to(HERE, RADIUS_M, Pose(2100.0, 0.0, 300.0, 0.0)) == ()


def test_a_zone_that_was_entered_is_left_at_once() -> None:
    """North, where the edge is nearest, though the way is to the south."""
    over = box(ZoneKind.KEEP_OUT, 1000.0, 2200.0, 900.0)
    out = way_out(HERE.pose, RADIUS_M, (over,))
    assert out is not None
    way = Router((over,)).way_to(HERE, RADIUS_M, Pose(-2000.0, 0.0, 300.0, math.pi))
    assert way[: len(out.points)] == out.points


@pytest.mark.parametrize("shut", [False, True])
def test_the_length_of_a_way_out_is_told_where_it_is_flown(shut: bool) -> None:
    """Out to the north is nearest; with walls there it leads on to nowhere, and another way is flown."""
    over = box(ZoneKind.KEEP_OUT, 1000.0, 2200.0, 900.0)
    walls = (
        box(ZoneKind.KEEP_OUT, 2700.0, 2800.0, 1000.0, 5),
        Zone(6, ZoneKind.KEEP_OUT, ((2150.0, 900.0), (2150.0, 1000.0), (2800.0, 1000.0), (2800.0, 900.0)), 0.0, 1000.0),
        Zone(7, ZoneKind.KEEP_OUT, ((2150.0, -1000.0), (2150.0, -900.0), (2800.0, -900.0), (2800.0, -1000.0)), 0.0, 1000.0),
    )  # fmt: skip
    zones = (over, *walls) if shut else (over,)
    mission = replace(meeting(), traffic=())
    config = Config(mission, Projection(mission.frame), (1,))
    begun = replace(first_state(mission, make_plan(mission)), aircraft=((1, HERE),))
    state = replace(task_transitions.begin(config, begun, []), zones=zones)
    way = Router(zones).way_to(HERE, RADIUS_M, Pose(-2000.0, 0.0, 300.0, math.pi))
    after = state.put(state.chain(1).enter(Phase.TRANSIT, Track(way), 0))
    told = changes._leaving(config, state, after)
    if shut:
        assert told == "vehicle 1 leaves keep-out zone 4 on its way"
    else:
        assert told.startswith(
            "vehicle 1 first leaves keep-out zone 4, level, by the shortest way found, "
        )


def handed_back(zones: tuple[Zone, ...], phase: Phase = Phase.TRANSIT) -> tuple[State, list[Any]]:
    """What the executive says when a vehicle is offered back at HERE, with these zones."""
    mission = replace(meeting(), traffic=())
    actor = Executive(Config(mission, Projection(mission.frame), (1,)))
    state = first_state(mission, make_plan(mission))
    start = AirState(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    state, _ = actor.handle(state, Begin(0, ((1, start),)))
    state, _ = actor.handle(state, SetOut())
    state, _ = actor.handle(state, Tick(250, ((1, HERE),)))
    state, _ = actor.handle(state, Suspend(1, 500, SUSPEND))
    state = replace(state.put(replace(state.chain(1), phase=phase)), zones=zones)
    state, out = actor.handle(state, TakeBack(1, 500, TAKE_BACK, 2))
    return state, [said.body for said in out if isinstance(said, Say)]


def commanded(said: list[Any]) -> tuple[Position, ...]:
    (command,) = of_type(said, "GatedCommand", Epoch=2)
    flown = decode(Projection(meeting().frame), command.Command, 0.0)
    assert isinstance(flown, Follow)
    return flown.track.points


@pytest.mark.parametrize("phase", [Phase.TRANSIT, Phase.TASK])
def test_where_no_way_back_keeps_the_zones_the_task_fails_and_nothing_else_is_flown(
    phase: Phase,
) -> None:
    state, said = handed_back((CAGE,), phase)
    (failed,) = of_type(said, "TaskProgress")
    assert (failed.Phase, failed.Note) == (lmcp.enums["TaskPhase"].Failed, task_transitions.NO_WAY)
    assert dict(state.failed) == {1: task_transitions.NO_WAY}
    assert not state.chain(1).suspended
    assert first_bad_leg((HERE.position, *commanded(said)), (CAGE,)) is None


def test_a_way_back_that_keeps_the_zones_is_flown() -> None:
    wall = box(ZoneKind.KEEP_OUT, 2600.0, 2700.0, 600.0)
    state, said = handed_back((wall,))
    assert (of_type(said, "TaskProgress"), state.failed) == ([], ())
    points = commanded(said)
    assert first_bad_leg(points, (wall,)) is None
    assert points[-1][:2] == pytest.approx((6000.0, 0.0), abs=20.0)


def test_the_kernel_says_what_the_search_for_a_way_leads_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(interruption, "way_act", lambda *_: FAIL_TASK)
    state, _ = handed_back(())
    assert dict(state.failed) == {1: task_transitions.NO_WAY}


def ended_at_here(zones: tuple[Zone, ...]) -> tuple[State, list[Any]]:
    """What the executive says when the chain of a vehicle ends at HERE, with these zones."""
    mission = replace(meeting(), traffic=())
    config = Config(mission, Projection(mission.frame), (1,))
    plan = make_plan(mission)
    state = replace(first_state(mission, replace(plan, items=())), zones=zones)
    out: list[Any] = []
    state = task_transitions.begin(config, replace(state, aircraft=((1, HERE),)), out)
    return state, [said.body for said in out if isinstance(said, Say)]


def test_who_ends_where_no_circle_keeps_the_zones_goes_where_one_does() -> None:
    """Walls on both sides of HERE, too near for a circle, open to the south and north."""
    walls = (
        Zone(1, ZoneKind.KEEP_OUT, ((1500.0, 200.0), (2400.0, 200.0), (2400.0, 100.0), (1500.0, 100.0)), 0.0, 1000.0),
        Zone(2, ZoneKind.KEEP_OUT, ((1500.0, 500.0), (2400.0, 500.0), (2400.0, 400.0), (1500.0, 400.0)), 0.0, 1000.0),
    )  # fmt: skip
    state, said = ended_at_here(walls)
    track = state.chain(1).track
    assert track.points[0] == HERE.position
    assert first_bad_leg(track.points, walls) is None
    assert first_bad_leg(remaining_path.last_lap(state.chain(1)), walls) is None
    assert of_type(said, "MissionChange") == []


def test_who_is_caught_among_zones_crosses_them_to_a_free_circle() -> None:
    """Walls on both sides of HERE and ahead: no turn back keeps them, circles would break them for ever."""
    spans = (
        (1500.0, 2400.0, 170.0, 270.0),
        (1500.0, 2400.0, 330.0, 430.0),
        (2080.0, 2180.0, 170.0, 430.0),
    )
    walls = tuple(
        Zone(k, ZoneKind.KEEP_OUT, ((s, w), (s, e), (n, e), (n, w)), 0.0, 1000.0)
        for k, (s, n, w, e) in enumerate(spans, 1)
    )  # fmt: skip
    state, said = ended_at_here(walls)
    (told,) = of_type(said, "MissionChange")
    assert told.Consequence == task_transitions.NO_WAY_OUT
    legs = itertools.pairwise(state.chain(1).track.points)
    bad_m = sum(math.dist(*leg) for leg in legs if first_bad_leg(leg, walls) is not None)
    assert 0.0 < bad_m < 500.0  # the worst of the ways that are tried: 1971 m
    assert first_bad_leg(remaining_path.last_lap(state.chain(1)), walls) is None


@pytest.mark.parametrize("on_m", [0.0, 150.0, 400.0])
def test_who_comes_back_to_its_last_circle_flies_whole_laps_of_it(on_m: float) -> None:
    state, _ = ended_at_here(())
    before = state.chain(1)
    lap = remaining_path.last_lap(before)
    config = Config(state.mission, Projection(state.mission.frame), (1,))
    away = AirState(Position(2600.0, -500.0, 320.0), 1.0, 22.0, 0.0)
    state = replace(state, aircraft=((1, away),)).put(replace(before, s_m=on_m))
    state = interruption.take_back(config, state, TakeBack(1, 2, 5000, TAKE_BACK), [])
    after = remaining_path.last_lap(state.chain(1))
    assert math.dist(after[0], after[-1]) < 1e-6
    middle = [sum(p[k] for p in lap[1:]) / (len(lap) - 1) for k in (0, 1)]
    radius_m = math.dist(lap[0][:2], middle)
    assert all(abs(math.dist(p[:2], middle) - radius_m) < 0.01 for p in after)


def test_a_place_beyond_a_zone_is_not_where_the_vehicle_is() -> None:
    """A wall between a vehicle and the end of its track, and the begin of its next one, 12 m to its side."""
    wall = Zone(4, ZoneKind.KEEP_OUT, ((1000.0, 303.0), (1000.0, 307.0), (3000.0, 307.0), (3000.0, 303.0)), 0.0, 1000.0)  # fmt: skip
    beside = Position(2000.0, 312.0, 300.0)
    mission = replace(meeting(), traffic=())
    (item,) = make_plan(mission).items
    item = replace(item, transit=(beside, *item.transit[1:]))
    ended = ended_at_here(())[0].chain(1)
    track = Track((beside._replace(north_m=1500.0), beside))
    for zones, kept in (((), True), ((wall,), False)):
        ways = Ways(zones, 0.25)
        last = ways.last(replace(ended, k=1, track=track), HERE, 0.0)
        assert (last.track.points[0] == beside) is kept
        assert first_bad_leg((HERE.position, *last.track.points), zones) is None
        way = ways.transit(replace(ended, items=(item,), k=0, phase=Phase.TRANSIT), HERE)
        assert way is not None
        assert (way.points[0] == beside) is kept
        assert first_bad_leg((HERE.position, *way.points), zones) is None


def test_who_can_circle_nowhere_says_so() -> None:
    cage = box(ZoneKind.KEEP_IN, 1990.0, 2010.0, 1000.0)
    state, said = ended_at_here((cage,))
    (told,) = of_type(said, "MissionChange")
    assert told.Consequence == task_transitions.NO_CIRCLE
    assert first_bad_leg(state.chain(1).track.points, (cage,)) is not None


def test_a_task_before_which_no_wait_keeps_the_zones_fails_by_name() -> None:
    mission = replace(meeting(), traffic=())
    config, plan = Config(mission, Projection(mission.frame), (1,)), make_plan(mission)
    start = AirState(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    state = replace(first_state(mission, plan), aircraft=((1, start),))
    state = task_transitions.begin(config, state, [])
    chain = state.chain(1)
    item = replace(chain.items[0], hold=None)
    pose = item.path[0]
    corners = (
        (pose.north_m - 900, pose.east_m - 40), (pose.north_m - 900, pose.east_m + 40),
        (pose.north_m + 900, pose.east_m + 40), (pose.north_m + 900, pose.east_m - 40),
    )  # fmt: skip
    state = replace(
        state.put(replace(chain, items=(item,))),
        zones=(Zone(3, ZoneKind.KEEP_IN, corners, 0.0, 1000.0),),
    )
    assert config.ways(state.zones).lap(state.chain(1), item) is None
    assert config.ways(()).lap(state.chain(1), item) is not None
    late = replace(state.plan, rows=(Row(NOT_BEFORE, item.task_id, (), 9_000_000, 0, "late"),))
    out: list[Any] = []
    after = task_transitions._on_end(config, replace(state, plan=late), state.chain(1), 500, out)
    assert dict(after.failed) == {item.task_id: task_transitions.NO_HOLD}


def test_what_is_left_and_what_is_entered_is_told_apart() -> None:
    over = box(ZoneKind.KEEP_OUT, 1900.0, 2200.0, 900.0, 9)
    beside = box(ZoneKind.KEEP_IN, 2100.0, 9000.0, 900.0, 5)
    state, _ = ended_at_here((beside, over))
    mission = replace(meeting(), traffic=())
    said = changes._leaving(Config(mission, Projection(mission.frame), (1,)), state, state)
    assert said.startswith(
        "vehicle 1 first leaves keep-out zone 9 and enters keep-in zone 5, level, by"
    )
