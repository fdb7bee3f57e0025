"""What is told of tasks that are not done in flight: the reason that holds now, of each task its own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from cratous.services.certify.timeline import Flight, _progress
from cratous.services.flight.changes import unplanned
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive_state import Asked, Config, first_state
from cratous.services.flight.messages import AskPlan, NotPlanned, Planned
from cratous.services.flight.omitted_tasks import leave_out, nothing_of
from cratous.services.flight.plan_reply import planned
from cratous.services.loading import load
from cratous.services.mission.availability import absent
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.plan import make_plan
from cratous.spec.executive import FOR_CHANGE
from cratous.spec.mission import Change, Position, Zone, ZoneKind
from cratous.spec.mission.changes import VEHICLE_JOINS, VEHICLE_LOST, known_at
from cratous.spec.mission.plan import Pose

LOST = Path(__file__).resolve().parents[1] / "missions" / "lost_vehicle.yaml"
OPEN: tuple[dict[int, int], dict[int, int], dict[int, str]] = ({}, {}, {})


def test_a_task_left_out_again_for_another_reason_says_the_new_one() -> None:
    plan = make_plan(replace(load(LOST), changes=()))
    left, said = leave_out(nothing_of(plan, [(2, "lost")]), OPEN, {}, {}, 1000)
    assert (left, [b.Note for b in said]) == ({2: "left out: lost"}, ["left out: lost"])
    same, said = leave_out(nothing_of(plan, [(2, "lost")]), OPEN, left, {}, 2000)
    assert (same, said) == (left, [])
    other, said = leave_out(nothing_of(plan, [(2, "a zone")]), OPEN, left, {}, 3000)
    both = "left out: a zone; when it was first left out: lost"
    assert other == {2: both}
    assert [(b.TaskID, b.Time, b.Note) for b in said] == [(2, 3000, both)]
    assert leave_out(nothing_of(plan, [(2, "a zone")]), OPEN, other, {}, 4000) == (other, [])
    assert leave_out(nothing_of(plan, [(2, "lost")]), OPEN, other, {}, 5000)[0] == left


def test_who_is_lost_is_not_lost_again() -> None:
    times = [
        (20_000, VEHICLE_LOST),
        (160_000, VEHICLE_LOST),
        (200_000, VEHICLE_JOINS),
        (210_000, VEHICLE_LOST),
    ]
    changes = tuple(Change(at, kind, vehicle=2) for at, kind in times)
    mission = replace(load(LOST), changes=changes)
    assert absent(mission, 170_000) == {2: "it was lost at 20.00 s"}
    assert absent(mission, 205_000) == {}
    assert absent(mission, 220_000) == {2: "it was lost at 210.00 s"}


def test_where_nothing_can_be_done_each_task_has_its_own_reason() -> None:
    mission = load(LOST)
    changes = (*mission.changes, Change(30_000, VEHICLE_LOST, vehicle=1))
    known = known_at(replace(mission, changes=changes), 30_000)
    away = ((1, "it was lost at 30.00 s"), (2, "it was lost at 20.00 s"))
    answer = planned(AskPlan(30_000, known, (), (), away, (), ()))
    assert isinstance(answer, NotPlanned)
    assert dict(answer.of) == {
        1: "no vehicle can do it: vehicle 1: it was lost at 30.00 s",
        2: "no vehicle can do it: vehicle 2: it was lost at 20.00 s",
    }
    assert "no vehicle can do task 1: vehicle 1" in answer.why, (
        "a label that is its number is not said"
    )


def test_of_tasks_that_nobody_can_do_any_more_each_says_its_own_reason() -> None:
    mission = replace(load(LOST), changes=())
    config = Config(mission, Projection(mission.frame), ())
    here = tuple((v.id, AirState(v.position, 0.0, 25.0, 0.0)) for v in mission.vehicles)
    state = replace(first_state(mission, make_plan(mission)), aircraft=here)
    out: list[Any] = []
    answer = NotPlanned("one; two", ((1, "one"),))
    state = unplanned(config, state, answer, Asked(FOR_CHANGE, "a change", ""), out)
    assert dict(state.left_out) == {1: "left out: one", 2: "left out: a change: one; two"}


def test_a_vehicle_in_a_zone_that_appeared_is_planned_for_from_its_way_out() -> None:
    corners = ((700.0, -300.0), (700.0, 300.0), (1300.0, 300.0), (1300.0, -300.0))
    zone = Zone(9, ZoneKind.KEEP_OUT, corners, 0.0, 5000.0)
    mission = replace(load(LOST), changes=(), zones=(zone,))
    starts = ((1, Pose(1000.0, 0.0, 400.0, 1.0)), (2, Pose(0.0, 6000.0, 600.0, 0.0)))
    answer = planned(AskPlan(10_000, mission, starts, (), (), (), ()))
    assert isinstance(answer, Planned)
    (item,) = answer.plan.chain(1)
    assert item.transit[0] == Position(1000.0, 0.0, 400.0)
    flown_m = sum(
        ((b.north_m - a.north_m) ** 2 + (b.east_m - a.east_m) ** 2) ** 0.5
        for a, b in zip(item.transit, item.transit[1:], strict=False)
    )
    assert abs((item.arrive_ms - item.depart_ms) - 1000 * flown_m / item.speed_m_s) < 500
    assert item.depart_ms == 10_000


def test_the_report_has_the_reason_that_was_told_last() -> None:
    flight = Flight()
    for at_ms, note in ((0, "first"), (20_000, "last")):
        body = {"VehicleID": 0, "TaskID": 3, "Time": at_ms, "Phase": "Failed", "Served": 0.0}
        _progress(flight, {**body, "Note": note})
    assert (flight.served[3]["note"], flight.served[3]["time_ms"]) == ("last", 0)
