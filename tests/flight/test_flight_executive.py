"""Plans in the air: order and timing by real times, waits, delays, interruption, zones, failure."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import flown, mission_within, of_type, traffic
from flight_tools import vehicle as blind
from mission_tools import must_fly

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.routing.polylines import Track
from cratous.services.flight.loop import FlightResult
from cratous.services.flight.timing import broken_by, closed_by, opens_ms
from cratous.services.pipeline.plan import make_plan
from cratous.spec import constraint_rows
from cratous.spec.mission import (
    Camera,
    Mission,
    Position,
    Simulation,
    Task,
    TaskKind,
    Traffic,
    Vehicle,
    Velocity,
    Zone,
    ZoneKind,
)
from cratous.spec.mission.plan import Plan, PlanItem

Flown = tuple[Plan, FlightResult, list[Any]]


def vehicle(vid: int, north: float, east: float) -> Vehicle:
    return replace(blind(vid, north, east), cameras=(Camera(),))


def ground(north: float, east: float) -> Position:
    return Position(north, east, 0.0)


LINE = Task(1, TaskKind.LINE_SEARCH, "road", (ground(1000, 0), ground(3000, 0)), eligible=(1,))
POINT = Task(2, TaskKind.POINT_SEARCH, "bridge", (ground(2000, 5000),), eligible=(2,))


def mission(relations: str, **changes: Any) -> Mission:
    """Two vehicles far apart: one searches a line, the other a point."""
    two = (vehicle(1, 0, 0), vehicle(2, 0, 5000))
    made = mission_within(1_200_000, two, (LINE, POINT), name="executive", relations=relations)
    return replace(made, **changes)


def phases(log: list[Any], task: int) -> list[str]:
    return [p.Phase.name for p in of_type(log, "TaskProgress", TaskID=task)]


@pytest.fixture(scope="module")
def in_order() -> Flown:
    """The point after the line, and nothing in the way."""
    m = mission(".(p1 p2)")
    plan = make_plan(m)
    return plan, *flown(m, plan)


def test_planned_times_are_flown(in_order: Flown) -> None:
    plan, result, log = in_order
    assert result.outcome == "complete"
    for item in plan.items:
        assert result.starts[item.task_id] == pytest.approx(item.start_ms, abs=1000)
        assert result.ends[item.task_id] == pytest.approx(item.end_ms, abs=1500)
    assert result.starts[2] >= result.ends[1]
    assert phases(log, 1) == ["Transit", "Active", "Complete"]


def test_vehicle_loiters_while_its_predecessor_is_not_done(in_order: Flown) -> None:
    plan, result, log = in_order
    (waiting,) = of_type(log, "TaskProgress", TaskID=2, Phase=lmcp.enums["TaskPhase"].Waiting)
    assert "p2" in waiting.Note
    hold = next(item.hold for item in plan.items if item.task_id == 2)
    assert hold is not None
    on_hold = [
        math.hypot(s.North - hold.north_m, s.East - hold.east_m)
        for s in of_type(log, "TruthState", VehicleID=2)
        if waiting.Time + 3000 < s.Time < result.starts[2] - 1000
    ]
    assert len(on_hold) > 40
    assert max(abs(r - hold.radius_m) for r in on_hold) < 5.0


def circled(duration_ms: int) -> tuple[int, int]:
    """When a loiter of this duration begins and ends."""
    around = Task(
        1, TaskKind.LOITER, "circle", (Position(0, 0, 300),), (1,), duration_ms=duration_ms,
        radius_m=250,
    )  # fmt: skip
    m = mission_within(1_200_000, (vehicle(1, 0, 0),), (around,), name="circle", relations="p1")
    result, _ = flown(m, make_plan(m))
    assert result.outcome == "complete"
    assert result.ends[1] - result.starts[1] <= duration_ms + m.simulation.step_ms
    return result.starts[1], result.ends[1]


def test_a_loiter_lasts_its_duration() -> None:
    """Flown a little inside its circle, the way would be over some milliseconds before."""
    begun, ended = circled(60_000)
    assert ended - begun >= 60_000
    # over 1 ms after a step has begun, so that the way ends in the step before
    step_ms = Simulation().step_ms
    longer = 60_000 + step_ms - (begun + 60_000) % step_ms + 1
    begun, ended = circled(longer)
    assert (begun + longer) % step_ms == 1
    assert ended == begun + longer


def delayed() -> Mission:
    """Traffic meets vehicle 1 on its line, so it gives way, goes back and ends late."""
    return mission(".(p1 p2)", traffic=(traffic(2800.0, -2800.0),))


@pytest.fixture(scope="module")
def late() -> Flown:
    """The delayed mission, flown."""
    m = delayed()
    plan = make_plan(m)
    return plan, *flown(m, plan)


def test_successor_waits_for_a_predecessor_delayed_by_traffic(late: Flown) -> None:
    plan, result, log = late
    planned = {item.task_id: item for item in plan.items}
    assert result.outcome == "complete"
    assert result.takeovers >= 1
    assert result.ends[1] > planned[1].end_ms + 10_000
    assert result.starts[2] >= result.ends[1]
    assert result.starts[2] <= result.ends[1] + 30_000
    assert phases(log, 1)[:4] == ["Transit", "Active", "Suspended", "Active"]


def test_interrupted_search_flies_its_whole_path(late: Flown) -> None:
    """Every place of the task's path is flown over while the task is active."""
    plan, _, log = late
    path = Track(next(item.path for item in plan.items if item.task_id == 1))
    active, marks, covered = False, set(), 0
    for body in log:
        name = type(body).__name__
        if name == "TaskProgress" and body.TaskID == 1:
            active = body.Phase.name == "Active"
        elif name == "TruthState" and body.VehicleID == 1 and active:
            p = Position(body.North, body.East, body.Altitude)
            near = path.nearest(p, 0.0, path.length_m)
            if abs(near.offset_m) < 6.0:
                marks.add(round(near.s_m / 10))
    covered = sum(any(k + d in marks for d in (-1, 0, 1)) for k in range(int(path.length_m / 10)))
    assert covered == int(path.length_m / 10)


def test_flight_obeys_a_keep_out_while_avoiding() -> None:
    zone = Zone(
        5,
        ZoneKind.KEEP_OUT,
        ((500.0, 60.0), (4000.0, 60.0), (4000.0, 1500.0), (500.0, 1500.0)),
        0.0,
        1000.0,
    )
    m = replace(delayed(), zones=(zone,))
    result, log = flown(m)
    assert result.outcome == "complete"
    assert result.takeovers >= 1
    states = of_type(log, "TruthState", VehicleID=1)
    for a, b in itertools.pairwise(states):
        p, q = Position(a.North, a.East, a.Altitude), Position(b.North, b.East, b.Altitude)
        assert leg_ok(p, q, zone), f"in the zone at {a.Time} ms"


def test_impossible_deadline_is_a_named_failure() -> None:
    """The plan could be met without the traffic; with it the window is missed for good."""
    m = delayed()
    plan = make_plan(m)
    end = next(item.end_ms for item in plan.items if item.task_id == 1)
    row = constraint_rows.Row(
        constraint_rows.NOT_AFTER, 1, (), 0, end + 4000, f"p1 ends at {end + 4000} ms or earlier"
    )
    result, log = flown(m, replace(plan, rows=(*plan.rows, row)))
    assert result.outcome == "failed"
    assert row.text in result.failed[1]
    (failed,) = of_type(log, "TaskProgress", TaskID=1, Phase=lmcp.enums["TaskPhase"].Failed)
    assert row.text in failed.Note
    # what waits for it can never begin, and is said to have failed too
    assert "task 1 failed" in result.failed[2]


POST = must_fly(1, (6000.0, 2500.0, 300.0), label="post")


def against(item: PlanItem, at_m: float = 2600.0, speed: float = 22.0) -> Traffic:
    """Traffic that comes head-on along the way to an item."""
    way = Track(item.transit)
    p, h = way.at(2 * at_m), way.heading_rad(2 * at_m)
    v = Velocity(-speed * math.cos(h), -speed * math.sin(h), 0.0)
    return Traffic(90, p, v)


def late_mission() -> tuple[Mission, PlanItem]:
    m = mission("p1", tasks=(POST,), vehicles=(vehicle(1, 0, 0), vehicle(2, -150, 5000)))
    (item,) = make_plan(m).items
    assert item.vehicle_id == 1
    return replace(m, traffic=(against(item),)), item


def test_vehicle_in_a_hurry_is_still_on_time() -> None:
    """Giving way costs a second or so; without a deadline it is lost, with one it is made up."""
    m, item = late_mission()
    free, _ = flown(m)
    assert free.ends[1] > item.end_ms
    bound, _ = flown(replace(m, relations=f"p1_[0-{item.end_ms}]"))
    assert (bound.outcome, bound.replans) == ("complete", 0)
    assert bound.ends[1] <= item.end_ms


def test_hopeless_plan_is_made_anew() -> None:
    """A row that the plan in force cannot keep leads to a new plan, from where all are then."""
    m, item = late_mission()
    row = constraint_rows.Row(
        constraint_rows.NOT_AFTER, 1, (), 0, item.end_ms - 60_000, "p1 ends a minute sooner"
    )
    plan = make_plan(m)
    result, log = flown(m, replace(plan, rows=(*plan.rows, row)))
    assert (result.outcome, result.replans) == ("complete", 1)
    (planned,) = of_type(log, "TaskProgress", Phase=lmcp.enums["TaskPhase"].Planned)
    assert row.text in planned.Note


def test_limit_ends_the_flight() -> None:
    m = mission("", simulation=Simulation(limit_ms=5000))
    result, log = flown(m)
    assert (result.outcome, result.end_ms) == ("limit", 5000)
    assert [e.Outcome for e in of_type(log, "MissionEnd")] == ["limit"]
    # every task has a final word
    said = {p.TaskID: p.Note for p in of_type(log, "TaskProgress") if p.Phase.name == "Failed"}
    assert said == dict.fromkeys(
        (task.id for task in m.tasks), "not served when the flight ended at its limit of 5 s"
    )
    assert result.failed == said


def test_one_state_of_everyone_each_step_and_heartbeats_each_period() -> None:
    m = mission("", traffic=delayed().traffic, simulation=Simulation(limit_ms=10_000))
    _, log = flown(m)
    for vid in (1, 2, 90):
        times = [s.Time for s in of_type(log, "TruthState", VehicleID=vid)]
        assert times == list(range(0, 10_001, 250))
    for vid in (1, 2):
        assert [s.Time for s in of_type(log, "AirVehicleState", ID=vid)] == list(
            range(0, 10_001, 500)
        )
        for way in lmcp.enums["Direction"]:
            beats = of_type(log, "Heartbeat", VehicleID=vid, Direction=way)
            assert [b.Time for b in beats] == list(range(0, 10_001, 500))


ROWS = (
    constraint_rows.Row(constraint_rows.AFTER_END, 2, (1,), 100, 0, "after the end"),
    constraint_rows.Row(constraint_rows.AFTER_START, 3, (1, 2), 0, 0, "after the start"),
    constraint_rows.Row(constraint_rows.NOT_BEFORE, 4, (), 500, 0, "not before"),
    constraint_rows.Row(constraint_rows.WITHIN_END, 5, (1,), 0, 1000, "within"),
)


def test_gate_in_time() -> None:
    assert closed_by(2, 900, ROWS, {1: 0}, {}) == ROWS[0]
    assert closed_by(2, 900, ROWS, {1: 0}, {1: 801}) == ROWS[0]
    assert closed_by(2, 900, ROWS, {1: 0}, {1: 800}) is None
    assert closed_by(3, 0, ROWS, {}, {}) == ROWS[1]
    assert closed_by(3, 40, ROWS, {2: 40}, {}) is None
    assert closed_by(4, 499, ROWS, {}, {}) == ROWS[2]
    assert opens_ms(2, ROWS, {}, {1: 800}) == 900
    assert broken_by(5, 0, 1801, ROWS, {}, {1: 800}) == ROWS[3]
    assert broken_by(5, 0, 1800, ROWS, {}, {1: 800}) is None
