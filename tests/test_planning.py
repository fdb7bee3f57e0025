"""Plans for whole missions: what is flown, seen, waited for, refused, and said on the bus."""

import json
import math
from itertools import pairwise

import pytest

from cratous.bridge import lmcp
from cratous.core.dubins import polyline_length_m
from cratous.core.earliest import rows_hold
from cratous.core.legs import first_bad_leg
from cratous.core.visibility import circle
from cratous.services.bus import Bus
from cratous.services.frames import Projection
from cratous.services.planning import make_plan
from cratous.services.planning.options import expand, flyer_of
from cratous.services.planning.smoothing import line_path
from cratous.services.sensor import coverage, footprint, sees
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import (
    Camera,
    Daa,
    Frame,
    Mission,
    Position,
    Task,
    TaskKind,
    Vehicle,
    View,
    WellClear,
    Zone,
    ZoneKind,
)
from cratous.spec.plan import Pose

CAMERA = Camera()
DOWN_LEFT = View(math.radians(-90), math.radians(-60))


def vehicle(number, north, east, heading=0.0, alt=700.0, cameras=(CAMERA,)):
    place = Position(north, east, alt)
    bank = math.radians(20)
    return Vehicle(
        number, f"UAV {number}", place, heading, 22.0, 18.0, 33.0, bank, 5.0, True, cameras
    )


def task(number, kind, *points, **more):
    return Task(number, kind, f"t{number}", tuple(Position(*p) for p in points), **more)


def box(number, kind, south, west, north, east):
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(number, kind, corners, 0.0, 5000.0)


TWO = (vehicle(1, 0.0, 0.0), vehicle(2, 0.0, 3000.0))
FOUR = (
    task(1, TaskKind.POINT_SEARCH, (3000.0, 0.0, 0.0)),
    task(2, TaskKind.POINT_SEARCH, (3000.0, 3000.0, 0.0)),
    task(3, TaskKind.MUST_FLY, (5000.0, 1500.0, 0.0)),
    task(4, TaskKind.LOITER, (2000.0, 1000.0, 0.0), duration_ms=120_000, radius_m=300.0),
)


def mission(tasks=FOUR, vehicles=TWO, **more):
    daa = Daa(WellClear(1000.0, 100.0, 30.0, 30.0))
    return Mission("m", "m.yaml", Frame(45.0, -120.0), vehicles, tasks, daa, **more)


def assert_flyable(plan, of):
    """Chains hang together in place and time, legs obey zones, rows hold, turns are wide enough."""
    starts = {item.task_id: item.start_ms for item in plan.items}
    ends = {item.task_id: item.end_ms for item in plan.items}
    assert rows_hold(plan.rows, starts, ends)
    assert sorted(starts) == sorted(plan.chosen)
    for one in of.vehicles:
        at, clock = one.position, 0
        for item in plan.chain(one.id):
            wanted = of.task(item.task_id).eligible
            assert not wanted or one.id in wanted
            assert math.dist(item.transit[0], at) < 1e-6
            assert math.dist(item.transit[-1], item.path[0]) < 1e-6
            assert item.depart_ms == clock
            flown = polyline_length_m(item.transit) / item.speed_m_s * 1000
            assert item.arrive_ms - item.depart_ms == pytest.approx(flown, abs=1.01)
            assert item.start_ms == item.arrive_ms + item.wait_ms
            along = polyline_length_m(item.path) / item.speed_m_s * 1000
            assert item.end_ms - item.start_ms == pytest.approx(along, abs=1.01)
            assert first_bad_leg(item.transit + item.path, of.zones) is None
            assert (item.hold is not None) == (item.wait_ms > 0)
            if item.hold is not None:
                radius = item.hold.radius_m
                laps = item.wait_ms * item.speed_m_s / 1000 / (2 * math.pi * radius)
                assert laps == pytest.approx(round(laps), abs=1e-6)
                assert radius >= flyer_of(one).radius_m * 0.999
                centre = (item.hold.north_m, item.hold.east_m)
                assert math.dist(centre, item.path[0][:2]) == pytest.approx(radius)
            assert_turns_wide(item.transit + item.path[1:], one)
            at, clock = item.path[-1], item.end_ms


def assert_turns_wide(points, one):
    """At each corner the turn is no sharper than the chords of the tightest circle make it."""
    radius = flyer_of(one).radius_m
    for p, q, r in zip(points, points[1:], points[2:], strict=False):
        if math.dist(p[:2], q[:2]) < 1e-6 or math.dist(q[:2], r[:2]) < 1e-6:
            continue
        first = math.atan2(q[1] - p[1], q[0] - p[0])
        second = math.atan2(r[1] - q[1], r[0] - q[0])
        turn = abs(math.remainder(second - first, 2 * math.pi))
        # half of each chord's arc lies on this side of the corner
        chords = math.dist(p[:2], q[:2]) + math.dist(q[:2], r[:2])
        assert turn <= chords / 2 / radius * 1.02 + 1e-6


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
    with pytest.raises(NoPlan) as error:
        make_plan(mission(relations="|(p1 p2_[0-60000] p3 p4)"))
    assert len(error.value.reasons) == 1
    assert "task 2 must end by 60.000 s" in error.value.reasons[0]
    assert "p2_[0-60000]" in error.value.reasons[0]
    earliest_s = float(error.value.reasons[0].split()[-2])
    alone = make_plan(mission(FOUR[1:2]))
    assert earliest_s == pytest.approx(alone.makespan_ms / 1000, abs=0.1)


def test_windows_that_clash_together_are_all_named():
    # each alone is possible for one vehicle, both together are not
    apart = (
        task(1, TaskKind.MUST_FLY, (4000.0, 0.0, 0.0)),
        task(2, TaskKind.MUST_FLY, (-4000.0, 0.0, 0.0)),
    )
    with pytest.raises(NoPlan) as error:
        make_plan(mission(apart, TWO[:1], relations="|(p1_[0-230000] p2_[0-230000])"))
    assert len(error.value.reasons) == 2
    assert "task 1" in error.value.reasons[0]
    assert "task 2" in error.value.reasons[1]


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


def test_a_task_behind_a_wall_is_named_with_the_zone():
    wall = box(1, ZoneKind.KEEP_OUT, 1000.0, -2000.0, 1500.0, 6000.0)
    room = box(2, ZoneKind.KEEP_IN, -3000.0, -1900.0, 8000.0, 5900.0)
    with pytest.raises(NoPlan, match=r"cannot|no vehicle can reach task 3.*keep-out zone 1"):
        make_plan(mission(FOUR[2:3], TWO[:1], zones=(wall, room)))


def test_a_line_through_a_keep_out_is_no_option():
    line = task(1, TaskKind.LINE_SEARCH, (1000.0, 0.0, 0.0), (4000.0, 0.0, 0.0))
    middle = box(3, ZoneKind.KEEP_OUT, 2000.0, -500.0, 2500.0, 500.0)
    with pytest.raises(NoPlan, match="its path breaks keep-out zone 3"):
        make_plan(mission((line,), zones=(middle,)))


# ---- cameras ----------------------------------------------------------------------------------


def test_the_footprint_straight_down_is_a_rectangle():
    here = Position(0.0, 0.0, 1000.0)
    quad = footprint(here, 0.0, CAMERA, (0.0, 0.0))
    half = 1000.0 * math.tan(CAMERA.hfov_rad / 2)
    assert sorted({round(e, 6) for _, e in quad}) == [round(-half, 6), round(half, 6)]
    assert max(n for n, _ in quad) == pytest.approx(half / CAMERA.aspect, rel=1e-6)
    assert sees(quad, (0.0, half - 1))
    assert not sees(quad, (0.0, half + 1))


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5])
def test_the_boresight_of_a_slanted_view_is_in_the_footprint(heading):
    here = Position(100.0, -50.0, 700.0)
    for bearing in range(0, 360, 30):
        target = (
            100.0 + 400 * math.cos(math.radians(bearing)),
            -50.0 + 400 * math.sin(math.radians(bearing)),
        )
        quad = footprint(here, heading, CAMERA, target)
        assert sees(quad, target)
        far = max(quad, key=lambda p: math.dist(p, here[:2]))
        assert math.dist(far, here[:2]) > 400


def test_there_is_no_footprint_where_a_corner_looks_above_the_horizon():
    here = Position(0.0, 0.0, 100.0)
    assert footprint(here, 0.0, CAMERA, (5000.0, 0.0)) is None
    assert footprint(here, 0.0, CAMERA, (0.0, 0.0), terrain_m=100.0) is None


def test_a_gimbal_stops_at_its_limits():
    fixed = Camera(min_azimuth_rad=0.0, max_azimuth_rad=0.0)
    here = Position(0.0, 0.0, 700.0)
    behind = (-400.0, 0.0)
    assert not sees(footprint(here, 0.0, fixed, behind), behind)
    assert sees(footprint(here, math.pi, fixed, behind), behind)


def test_a_flight_elsewhere_covers_nothing():
    line = task(1, TaskKind.LINE_SEARCH, (0.0, 0.0, 0.0), (2000.0, 0.0, 0.0))
    over = (Position(-100.0, 0.0, 700.0), Position(2100.0, 0.0, 700.0))
    far = tuple(p._replace(east_m=5000.0) for p in over)
    half = (Position(-100.0, 0.0, 700.0), Position(1000.0, 0.0, 700.0))
    assert coverage(over, line, CAMERA) == 1.0
    assert coverage(far, line, CAMERA) == 0.0
    assert 0.5 < coverage(half, line, CAMERA) < 0.75


@pytest.mark.parametrize("view", [None, DOWN_LEFT, View(math.radians(35), math.radians(-60))])
def test_a_crooked_line_is_covered_by_a_flyable_path(view):
    points = [(300.0 * k, 250.0 * (-1) ** k * (k % 3), 0.0) for k in range(12)]
    line = task(1, TaskKind.LINE_SEARCH, *points, view=view)
    made = line_path(line, CAMERA, 150.0, 700.0, 0.0)
    assert made.coverage >= 0.99
    assert coverage(made.points, line, CAMERA) >= 0.99
    assert_turns_wide(made.points, TWO[0])


def test_the_view_of_a_point_is_from_the_wanted_side():
    wanted = View(math.radians(90), math.radians(-60))
    point = task(1, TaskKind.POINT_SEARCH, (2000.0, 0.0, 0.0), view=wanted)
    of = mission((point,))
    options, dropped = expand(of, of.tasks, ())
    assert len(options) == 18
    assert dropped == ()
    for option in options:
        middle = option.path[1]
        away = math.dist(middle[:2], (2000.0, 0.0))
        assert away == pytest.approx(700.0 / math.tan(math.radians(60)))
        # the target lies to the right of the direction of flight
        bearing = math.atan2(-middle.east_m, 2000.0 - middle.north_m)
        turn = math.remainder(bearing - option.start.heading_rad, 2 * math.pi)
        assert turn == pytest.approx(math.pi / 2, abs=1e-9)


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


# ---- the messages -----------------------------------------------------------------------------


def test_the_pipeline_speaks_the_messages_of_uxas_in_order():
    of = mission(relations=".(p1 p2)-[60000-200000]")
    bus = Bus(lmcp.full_names)
    seen = []
    bus.tap(lambda e: seen.append((e.topic.rsplit(".", 1)[-1], e.source, e.body)))
    plan = make_plan(of, bus)
    names = [name for name, _, _ in seen]
    chain = [
        "AutomationRequest",
        "UniqueAutomationRequest",
        "TaskPlanOptions",
        "RoutePlanRequest",
        "RoutePlanResponse",
        "AssignmentCostMatrix",
        "TaskAssignmentSummary",
        "TaskImplementationRequest",
        "TaskImplementationResponse",
        "UniqueAutomationResponse",
        "AutomationResponse",
    ]
    places = [names.index(name) for name in chain]
    assert places == sorted(places)
    assert names.count("TaskPlanOptions") == 2
    assert names.count("AutomationResponse") == 1

    by_name = {name: body for name, _, body in seen}
    offered = {
        (o.TaskID, o.OptionID): o for name, _, b in seen if name == "TaskPlanOptions"
        for o in b.Options
    }  # fmt: skip
    matrix = by_name["AssignmentCostMatrix"].CostMatrix
    assert {(r.DestinationTaskID, r.DestinationTaskOption) for r in matrix} == set(offered)
    for item, told in zip(plan.items, by_name["TaskAssignmentSummary"].TaskList, strict=True):
        assert (told.TaskID, told.OptionID) == (item.task_id, item.option_id)
        assert told.AssignedVehicle == item.vehicle_id
        assert told.TimeTaskCompleted == item.end_ms
        assert offered[item.task_id, item.option_id].Cost == item.end_ms - item.start_ms

    projection = Projection(of.frame)
    commands = {c.VehicleID: c for c in by_name["AutomationResponse"].MissionCommandList}
    assert set(commands) == {item.vehicle_id for item in plan.items}
    for number, command in commands.items():
        points = command.WaypointList
        assert [w.Number for w in points] == list(range(1, len(points) + 1))
        assert all(a.NextWaypoint == b.Number for a, b in pairwise(points))
        flown = [projection.to_local(w.Latitude, w.Longitude) for w in points]
        planned = [p for item in plan.chain(number) for p in (*item.transit[:-1], *item.path)]
        assert len(flown) == len(planned)
        assert max(math.dist(a, b[:2]) for a, b in zip(flown, planned, strict=True)) < 1e-4
    waits = [
        a for c in commands.values() for w in c.WaypointList for a in w.VehicleActionList
        if type(a).__name__ == "LoiterAction"
    ]  # fmt: skip
    held = [item for item in plan.items if item.hold]
    assert [a.Duration for a in waits] == [item.wait_ms for item in held]
    assert waits[0].Radius == pytest.approx(held[0].hold.radius_m)


def test_a_failed_request_ends_in_an_error_status_with_the_reasons():
    bus = Bus(lmcp.full_names)
    said = []
    bus.tap(lambda e: said.append(e.body) if e.topic.endswith("ServiceStatus") else None)
    with pytest.raises(NoPlan) as error:
        make_plan(mission(relations="|(p1 p2_[0-60000])"), bus)
    assert said[-1].StatusType == lmcp.enums["ServiceStatusType"].Error
    told = [pair.Value for pair in said[-1].Info if pair.Key == "reason"]
    assert tuple(told) == error.value.reasons
    # the bus is fit for the next request
    assert make_plan(mission(relations="|(p1 p2)"), bus).items


def test_a_hold_circle_comes_back_to_its_pose():
    points = circle(Pose(10.0, 20.0, 300.0, 0.7), 150.0, True)
    assert points[0] == points[-1]
    assert polyline_length_m(points) == pytest.approx(2 * math.pi * 150.0, rel=2e-3)
