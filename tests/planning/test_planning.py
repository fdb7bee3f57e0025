"""Plans for whole missions: what is flown, waited for, planned again and refused."""

import json
import math
from dataclasses import replace

import pytest
from planning_tools import FOUR, TWO, assert_flyable, box, mission, task, vehicle

from cratous.bridge import lmcp
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.visibility import circle
from cratous.services.bus import Bus
from cratous.services.mission.sensor import coverage
from cratous.services.pipeline.plan import make_plan
from cratous.services.planning.options import expand
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Camera, Position, TaskKind, ZoneKind
from cratous.spec.mission.plan import Pose, left_out_of

# ---- whole missions ---------------------------------------------------------------------------


RELATIONS = [
    "",
    ".(p1 p2 p3 p4)",
    "~(p4 p2 .(p1 p3))",
    "+(.(p1 p2) .(p3 p4))",
    "|(p1_[300000-400000] p2 p3 p4)",
    ".(p1 p2)-[60000-200000]",
    ".(|(p1 p2)-[0-200000] p3)",
]


@pytest.mark.parametrize("text", RELATIONS)
def test_a_plan_holds_and_is_flyable(text):
    of = mission(relations=text)
    assert_flyable(make_plan(of), of)


def test_a_wait_is_a_loiter_where_the_order_needs_it():
    of = mission(relations=".(p1 p2)-[60000-200000]")
    plan = make_plan(of)
    last = next(item for item in plan.items if item.task_id == 2)
    assert last.wait_ms > 0
    first = next(item for item in plan.items if item.task_id == 1)
    assert last.start_ms >= first.end_ms + 60_000


def test_zones_are_flown_around():
    wall = box(1, ZoneKind.KEEP_OUT, 1000.0, -2000.0, 1500.0, 6000.0)
    room = box(2, ZoneKind.KEEP_IN, -3000.0, -6000.0, 8000.0, 9000.0)
    of = mission(FOUR[:1], TWO[:1], zones=(wall, room))
    plan = make_plan(of)
    assert_flyable(plan, of)
    free = make_plan(mission(FOUR[:1], TWO[:1]))
    assert plan.makespan_ms > free.makespan_ms


def test_the_reading_by_order_lets_a_successor_start_early():
    tasks = (
        task(1, TaskKind.LOITER, (3000.0, 0.0, 0.0), duration_ms=600_000, eligible=(1,)),
        task(2, TaskKind.MUST_FLY, (500.0, 3000.0, 0.0), eligible=(2,)),
    )
    strict = make_plan(mission(tasks, relations=".(p1 p2)"))
    loose = make_plan(mission(tasks, relations=".(p1 p2)", order="order"))
    assert strict.makespan_ms > 600_000 + 100_000
    assert min(item.end_ms for item in loose.items) < 60_000


def test_the_costs_differ():
    of = mission(FOUR[:3])
    total = {
        cost: sum(max((i.end_ms for i in plan.chain(v.id)), default=0) for v in of.vehicles)
        for cost, plan in (
            (cost, make_plan(mission(FOUR[:3], cost=cost))) for cost in ("MINMAX", "CUMULATIVE")
        )
    }
    assert total["CUMULATIVE"] <= total["MINMAX"]


def test_the_same_mission_gives_the_same_messages_and_plan():
    logs, plans = [], []
    for _ in range(2):
        bus = Bus(lmcp.full_names)
        log: list[str] = []
        bus.tap(lambda e, log=log: log.append(f"{e.seq} {e.source} {lmcp.to_json(e.body)}"))
        plans.append(make_plan(mission(), bus))
        logs.append(log)
    assert logs[0] == logs[1]
    assert plans[0] == plans[1]


def test_a_long_dwell_is_flown_in_circles():
    point = task(1, TaskKind.POINT_SEARCH, (2000.0, 0.0, 0.0), duration_ms=300_000)
    of = mission((point,))
    options, _ = expand(of, of.tasks, ())
    assert options
    for option in options:
        assert option.duration_ms == 300_000
        assert {round(math.dist(p[:2], (2000.0, 0.0)), 3) for p in option.path} == {
            round(option.flyer.radius_m, 3)
        }


def test_a_hold_circle_comes_back_to_its_pose():
    points = circle(Pose(10.0, 20.0, 300.0, 0.7), 150.0, True)
    assert points[0] == points[-1]
    assert polyline_length_m(points) == pytest.approx(2 * math.pi * 150.0, rel=2e-3)


# ---- planning again, in flight ----------------------------------------------------------------


def test_planning_again_keeps_what_is_done_and_starts_from_where_they_are():
    of = mission(relations=".(p1 p2 p3 p4)")
    bus = Bus(lmcp.full_names)
    first = make_plan(of, bus)
    starts = {1: Pose(2500.0, 500.0, 700.0, 1.0), 2: Pose(2500.0, 2500.0, 700.0, 0.0)}
    done = [(1, 130_000, 260_000)]
    plan = make_plan(of, bus, starts=starts, done=done, now_ms=200_000)
    assert sorted(item.task_id for item in plan.items) == [2, 3, 4]
    assert set(plan.chosen) == set(first.chosen)
    for item in plan.items:
        assert item.depart_ms >= 200_000
        if plan.chain(item.vehicle_id)[0] is item:
            assert item.transit[0] == Position(*starts[item.vehicle_id][:3])
    second = next(item for item in plan.items if item.task_id == 2)
    assert second.start_ms >= 260_000


def test_a_vehicle_that_was_pushed_down_climbs_back_to_its_altitude():
    low = {1: Pose(0.0, 0.0, 550.0, 0.0)}
    plan = make_plan(mission(FOUR[:1], TWO[:1]), starts=low, now_ms=1000)
    item = plan.items[0]
    assert item.transit[0].alt_m == 550.0
    assert {p.alt_m for p in item.path} == {700.0}


def test_nothing_left_is_an_empty_plan():
    of = mission(relations="+(p1 p2)")
    plan = make_plan(of, starts={}, done=[(2, 5, 77)], now_ms=80)
    assert plan.items == ()
    assert plan.makespan_ms == 77
    with pytest.raises(NoPlan, match="fits no branch"):
        make_plan(of, done=[(3, 5, 77)])


# ---- what is refused --------------------------------------------------------------------------


def test_an_impossible_window_is_named_with_the_earliest_end():
    plan = make_plan(mission(relations="|(p1 p2_[0-60000] p3 p4)"))
    assert sorted(item.task_id for item in plan.items) == [1, 3, 4]
    (left,) = left_out_of(plan)
    assert (left.task_id, left.instead, left.waiting) == (2, (), ())
    assert "task 2 must end by 60.000 s" in left.reason
    assert "p2_[0-60000]" in left.reason
    earliest_s = float(left.reason.split()[-2])
    alone = make_plan(mission(FOUR[1:2]))
    assert earliest_s == pytest.approx(alone.makespan_ms / 1000, abs=0.1)


def test_windows_that_clash_together_are_all_named():
    # each alone is possible for one vehicle, both together are not
    apart = (
        task(1, TaskKind.MUST_FLY, (4000.0, 0.0, 0.0)),
        task(2, TaskKind.MUST_FLY, (-4000.0, 0.0, 0.0)),
    )
    plan = make_plan(mission(apart, TWO[:1], relations="|(p1_[0-230000] p2_[0-230000])"))
    assert [item.task_id for item in plan.items] == [1]
    (left,) = left_out_of(plan)
    assert (left.task_id, left.instead) == (2, (1,))
    assert left.reason.startswith("not beside task 1: ")
    assert "task 1 must end by 230.000 s" in left.reason
    assert "task 2 must end by 230.000 s" in left.reason
    # what is dearer to the user goes first
    higher = (apart[0], replace(apart[1], priority=1))
    plan = make_plan(mission(higher, TWO[:1], relations="|(p1_[0-230000] p2_[0-230000])"))
    assert [item.task_id for item in plan.items] == [2]


def test_a_start_in_a_keep_out_or_outside_a_keep_in_is_bad_input():
    for zone, word in (
        (box(5, ZoneKind.KEEP_OUT, -100.0, -100.0, 100.0, 100.0), "inside keep-out zone 5"),
        (box(6, ZoneKind.KEEP_IN, 100.0, -9000.0, 9000.0, 9000.0), "outside of keep-in zone 6"),
    ):
        with pytest.raises(BadInput, match=word) as error:
            make_plan(mission(zones=(zone,)))
        assert error.value.item == "vehicles[0].position"
        assert error.value.where == "m.yaml"


def test_a_task_that_nobody_can_do_is_named_with_each_reason():
    infrared = task(9, TaskKind.POINT_SEARCH, (1000.0, 0.0, 0.0), wavelength="SWIR")
    blind = (
        vehicle(1, 0.0, 0.0, cameras=(Camera(wavelength="EO"),)),
        vehicle(2, 0.0, 9.0, cameras=()),
    )
    with pytest.raises(NoPlan) as error:
        make_plan(mission((infrared,), blind))
    assert "task 9 (t9)" in error.value.reasons[0]
    assert "vehicle 1: it has no camera for wavelength SWIR" in error.value.reasons[0]
    assert "vehicle 2" in error.value.reasons[0]
    # what waits for it is named as well, where nothing else is asked for
    with pytest.raises(NoPlan) as error:
        make_plan(mission((FOUR[0], infrared), blind, relations=".(p9 p1)"))
    one, two = error.value.reasons
    assert one.startswith("no vehicle can do task 9")
    assert two.startswith("task 1 (it must wait for what is not done: `.(p9 p1)`")


def test_a_task_behind_a_wall_is_named_with_the_zone():
    wall = box(1, ZoneKind.KEEP_OUT, 1000.0, -2000.0, 1500.0, 6000.0)
    room = box(2, ZoneKind.KEEP_IN, -3000.0, -1900.0, 8000.0, 5900.0)
    with pytest.raises(NoPlan, match=r"cannot|no vehicle can reach task 3.*keep-out zone 1"):
        make_plan(mission(FOUR[2:3], TWO[:1], zones=(wall, room)))


def test_a_line_that_a_keep_out_covers_is_no_option():
    line = task(1, TaskKind.LINE_SEARCH, (1000.0, 0.0, 0.0), (4000.0, 0.0, 0.0))
    whole = box(3, ZoneKind.KEEP_OUT, 500.0, -500.0, 4500.0, 500.0)
    with pytest.raises(NoPlan, match="keep-out zone 3"):
        make_plan(mission((line,), zones=(whole,)))


# ---- the waterway -----------------------------------------------------------------------------


def test_the_waterway_is_planned_at_least_as_well_as_recorded(shared):
    from cratous.services.loading import load

    folder = shared / "examples" / "openuxas" / "waterway"
    if not folder.is_dir():
        pytest.skip("the waterway example is not on this machine")
    of = load(folder)
    plan = make_plan(of)
    assert_flyable(plan, of)
    summary = json.loads((folder / "TaskAssignmentSummary.json").read_text())[0]["obj"]
    recorded = summary["TaskList"][0]
    assert plan.items[0].vehicle_id == recorded["AssignedVehicle"] == 400
    assert plan.makespan_ms <= recorded["TimeTaskCompleted"]
    assert plan.exhausted
    line = of.task(1000)
    seen = coverage(plan.items[0].path, line, of.vehicle(400).cameras[0], of.frame.terrain_m)
    assert seen >= 0.99
