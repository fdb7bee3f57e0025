"""What would have to change so that a task that is left out could be done: tried, and as data."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from planning_tools import FOUR, TWO, box, mission, task

from cratous.services.cli.plan_lines import left_out_lines
from cratous.services.loading import load
from cratous.services.logs.records import to_data
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission, TaskKind, ZoneKind
from cratous.spec.mission.plan import LeftOut, left_out_of

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "partial" / "mission.yaml"
POINT = task(1, TaskKind.MUST_FLY, (3000.0, 0.0, 0.0))
FREE = task(2, TaskKind.MUST_FLY, (3000.0, 3000.0, 0.0))
ON_POINT = box(7, ZoneKind.KEEP_OUT, 2800.0, -200.0, 3200.0, 200.0)
AROUND = box(8, ZoneKind.KEEP_OUT, 2700.0, -300.0, 3300.0, 300.0)
AWAY = box(9, ZoneKind.KEEP_OUT, 8000.0, 0.0, 8500.0, 500.0)


def left(of: Mission, **how: object) -> LeftOut:
    (one,) = left_out_of(make_plan(of, **how))  # type: ignore[arg-type]
    return one


def test_the_zone_that_is_in_the_way_is_found_among_others() -> None:
    plan = make_plan(mission((POINT, FREE), zones=(AWAY, ON_POINT)))
    (one,) = left_out_of(plan)
    (remedy,) = one.remedies
    assert (remedy.kinds, remedy.zones, remedy.vehicles, remedy.tried) == (
        ("zone",),
        (7,),
        (1, 2),
        True,
    )
    assert left_out_lines(plan)[1] == (
        "  task 1 could be done: without keep-out zone 7 vehicle 1, vehicle 2 could do it"
    )
    data = to_data(plan)["left_out"][0]["remedies"][0]
    assert (list(data["kinds"]), list(data["zones"])) == (["zone"], [7])


def test_two_zones_on_one_point_are_taken_away_together_and_no_less() -> None:
    one = left(mission((POINT, FREE), zones=(AWAY, ON_POINT, AROUND)))
    assert [remedy.zones for remedy in one.remedies] == [(7, 8)]


def test_what_is_said_to_help_does() -> None:
    of = mission((POINT, FREE), zones=(AWAY, ON_POINT, AROUND))
    gone = set(left(of).remedies[0].zones)
    without = replace(of, zones=tuple(zone for zone in of.zones if zone.id not in gone))
    assert left_out_of(make_plan(without)) == ()


def test_a_vehicle_that_is_lost_and_one_that_may_not() -> None:
    """Only vehicle 3 may do it, which was lost: it could come back, or another could be named."""
    of = mission((replace(POINT, eligible=(3,)), FREE))
    named, back = left(of, absent={3: "it was lost at 30.00 s"}).remedies
    assert (named.kinds, named.vehicles, named.tried) == (("eligibility",), (1, 2), True)
    assert (back.kinds, back.vehicles, back.tried) == (("vehicle",), (3,), False)
    windy = left(
        of, absent={3: "it can hold no speed over the ground in a wind of 30 m/s"}
    ).remedies[1]
    assert windy.kinds == ("wind",)


def test_times_and_order_are_reasons_too() -> None:
    first, second = left_out_of(make_plan(mission(FOUR, TWO, relations="|(.(p1_[0-9] p2) p3 p4)")))
    assert [remedy.kinds for remedy in first.remedies] == [("time",)]
    (order,) = second.remedies
    assert (order.kinds, order.tasks) == (("order",), (1,))


def test_the_example_has_a_remedy_for_every_task_that_is_left_out() -> None:
    (one,) = left_out_of(make_plan(load(EXAMPLE)))
    assert one.task_id == 1
    window, instead = one.remedies
    assert (window.kinds, instead.kinds, instead.tasks) == (("time",), ("time",), (2,))


@pytest.mark.parametrize("undone", [{1: "its window was missed"}])
def test_what_has_ended_undone_has_none(undone: dict[int, str]) -> None:
    assert left(mission((POINT, FREE)), undone=undone).remedies == ()
