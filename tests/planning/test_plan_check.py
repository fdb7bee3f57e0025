"""The plan check takes nothing from the planner but its result: tampered plans are caught."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from mission_tools import must_fly, plain_mission, plain_vehicle

from cratous.services.monitor.plan_check import check_plan
from cratous.services.monitor.relations import row_choices
from cratous.spec.mission import Mission, Position, Zone, ZoneKind
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.plan import Hold, Plan, PlanItem


def place(north: float, east: float = 0.0) -> Position:
    return Position(north, east, 100.0)


VEHICLES = tuple(plain_vehicle(k, place(0.0)) for k in (1, 2))
TASKS = (must_fly(1, place(1000.0), eligible=(1,)), must_fly(2, place(2000.0)))
ZONE = Zone(5, ZoneKind.KEEP_OUT, ((500.0, 50.0), (600.0, 50.0), (600.0, 90.0)), 0.0, 1000.0)
MISSION = plain_mission(
    VEHICLES, TASKS, zones=(ZONE,), relations=".(p1 p2)_[0-300000]", instances=(1, 2)
)
FIRST = PlanItem(
    1, 1, 1, (place(0), place(900)), (place(900), place(1000)), None, 20.0,
    0, 45_000, 0, 45_000, 50_000, 0.0,
)  # fmt: skip
SECOND = PlanItem(
    2, 1, 2, (place(0), place(1900)), (place(1900), place(2000)), None, 20.0,
    0, 95_000, 0, 95_000, 100_000, 0.0,
)  # fmt: skip
PLAN = Plan("test", (FIRST, SECOND), (), (1, 2), 100_000, "MINMAX", 1, True)


def bad(plan: Plan, mission: Mission = MISSION) -> list[str]:
    return [v.item for v in check_plan(mission, plan) if v.outcome is not Outcome.HOLDS]


def test_a_good_plan_holds_in_everything():
    verdicts = check_plan(MISSION, PLAN)
    assert bad(PLAN) == []
    names = " ".join(v.item for v in verdicts)
    for part in ("eligibility: task 1", "chain: vehicle 2", "zone: keep_out 5", "p2 starts"):
        assert part in names
    (zone, _) = [v for v in verdicts if v.item.startswith("zone")]
    assert zone.margin == pytest.approx(50.0)


def tampered(**changes: Any) -> Plan:
    return replace(PLAN, items=(FIRST, replace(SECOND, **changes)))


@pytest.mark.parametrize("relations", ["+(.(p1 p2) .(p2 p1))", "+(.(p2 p1) .(p1 p2))"])
def test_of_branches_with_the_same_tasks_the_one_that_is_kept_counts(relations: str):
    mission = replace(MISSION, relations=relations)
    assert bad(PLAN, mission) == []
    assert "plan: `.(p1 p2)`: p2 starts no earlier than p1 ends" in {
        v.item for v in check_plan(mission, PLAN)
    }
    together = tampered(depart_ms=0, arrive_ms=45_000, start_ms=45_000, end_ms=50_000)
    assert "plan: all order and timing rows at once" in bad(together, mission)


def test_of_many_choices_only_the_branches_of_the_chosen_tasks_are_made():
    """2^40 branches, one of which has these tasks: whoever makes them all never ends."""
    ids = range(1, 81)
    tasks = tuple(replace(TASKS[1], id=n) for n in ids)
    pairs = " ".join(f"+(p{n} p{n + 1})" for n in ids if n % 2)
    mission = replace(MISSION, tasks=tasks, relations=f".({pairs})")
    (rows,) = row_choices(mission, frozenset(n for n in ids if n % 2))
    assert {row.i for row in rows} == {n for n in ids if n % 2} - {1}


def test_order_is_recomputed_from_the_mission():
    early = tampered(start_ms=49_999, arrive_ms=49_999, end_ms=54_999)
    found = bad(early)
    assert any("p2 starts no earlier than p1 ends" in item for item in found)
    assert "plan: all order and timing rows at once" in found


def test_a_flight_faster_than_the_aircraft_is_caught():
    assert "chain: vehicle 2" in bad(tampered(end_ms=99_000))
    assert "chain: vehicle 2" in bad(tampered(depart_ms=5_000))


def test_a_plan_that_jumps_is_caught():
    gone = tampered(path=(place(1900.0, 3000.0), place(2000.0, 3000.0)))
    assert "chain: vehicle 2" in bad(gone)


def test_an_ineligible_vehicle_is_caught():
    plan = replace(PLAN, items=(replace(FIRST, vehicle_id=2), replace(SECOND, vehicle_id=1)))
    assert "eligibility: task 1" in bad(plan)


def test_missing_and_repeated_tasks_are_caught():
    wanted = "plan: every task of one choice, once"
    assert wanted in bad(replace(PLAN, items=(FIRST,)))
    assert wanted in bad(replace(PLAN, items=(FIRST, SECOND, SECOND)))


def test_a_leg_that_only_touches_a_keep_out_is_caught():
    touching = replace(ZONE, vertices=((500.0, 0.0), (600.0, 50.0), (600.0, 90.0)))
    found = check_plan(replace(MISSION, zones=(touching,)), PLAN)
    zones = [v for v in found if v.item.startswith("zone") and v.outcome is Outcome.VIOLATED]
    assert {str(v.margin) for v in zones} == {"0.0"}, "not -0.0"


def test_the_circle_of_a_wait_is_checked_too():
    hold = Hold(1900.0, 150.0, 100.0, 150.0, True)
    zone = Zone(
        6, ZoneKind.KEEP_OUT, ((1890.0, 290.0), (1910.0, 290.0), (1900.0, 310.0)), 0.0, 200.0
    )
    plan = tampered(hold=hold, wait_ms=60_000, start_ms=155_000, end_ms=160_000)
    found = bad(plan, replace(MISSION, zones=(zone,)))
    assert found == ["zone: keep_out 6, planned route of vehicle 2"]


def test_a_window_that_is_missed_is_named_with_its_margin():
    late = tampered(start_ms=300_000, arrive_ms=300_000, end_ms=305_000)
    (verdict, _) = [v for v in check_plan(MISSION, late) if v.outcome is Outcome.VIOLATED]
    assert verdict.margin == pytest.approx(-5.0)
    assert verdict.unit == "s"
