"""How long one waits at a rendezvous, when it leaves its circle, and who is sent on when the task is over."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import place, request
from rendezvous_tools import PLACES, coming, sent_on, under_way, waiting

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.services.following.speeds import Limits, waiting_of
from cratous.services.planning.performance_classes import Flyer

pytestmark = pytest.mark.usefixtures("straight_run_ins")


@pytest.mark.parametrize("change", [{"AssociatedTasks": []}, {"Location": place(math.nan)}])
def test_nobody_waits_without_end_for_who_is_heard_and_does_not_come(
    tmp_path: Path, change: dict[str, Any]
) -> None:
    """The second one flies something else, or its states are no states, for as long as one looks."""
    wait = lmcp.new("KeyValuePair", Key="Wait_ms", Value="60000")
    rig, (one, two) = coming(tmp_path, Parameters=[wait])
    here = waiting(rig, one)
    for k in range(2, 62):
        rig.tell(two.copy(Time=1000 * k, **change), here.copy(Time=1000 * k))
    assert not [t for t in rig.reasons("Warning") if "do not meet" in t], "no longer than 60 s"
    rig.tell(two.copy(Time=62_000, **change))
    text = "task 5: its vehicles do not meet: vehicle 1 has waited for 60 s (Wait_ms), and 2 has not come"
    assert text in rig.reasons("Warning")
    assert sent_on(rig) == 1


@pytest.mark.parametrize("end", ["another request", "the other one"])
def test_nobody_stays_on_its_circle_when_the_task_has_ended(tmp_path: Path, end: str) -> None:
    """Also who has not yet said that it circles."""
    rig, (one, two) = coming(tmp_path)
    rig.tell(one.copy(CurrentWaypoint=one.CurrentWaypoint - 1), two)
    assert sent_on(rig) != 1
    if end == "another request":
        rig.tell(request(5, vehicles=(1, 2)))
    else:
        rig.tell(two.copy(AssociatedTasks=[], Time=1200))
    assert sent_on(rig) == 1


def behind(two: Any, time_ms: int, north: float) -> Any:
    """A state of the second vehicle, so many degrees before its place."""
    return two.copy(Location=place(PLACES[1][0] - north, PLACES[1][1]), Time=time_ms)


def test_who_waits_leaves_at_the_end_of_its_last_lap(tmp_path: Path) -> None:
    """The common time is at 80.6 s, the way 466 m long, a lap at 10 m/s takes 12.2 s: so between 45.1 and 57.3 s,
    although at 5 m/s it would be in time sooner."""
    rig, (one, two) = coming(tmp_path, slowest=5.0)
    here = waiting(rig, one)
    for time_ms, north in ((1_000, 0.0144), (20_000, 0.0109), (40_000, 0.0073)):
        rig.tell(behind(two, time_ms, north), here.copy(Time=time_ms))
    assert 1 not in left(rig), "there is time for another lap"
    rig.tell(behind(two, 50_000, 0.0055), here.copy(Time=50_000, Heading=180.0))
    assert 1 not in left(rig), "it heads away"
    rig.tell(here.copy(Time=50_500))
    assert 1 in left(rig)


def test_who_waits_flies_slowly_where_that_makes_its_laps_shorter(tmp_path: Path) -> None:
    """A quarter of the radius at half of the speed; to its circle it comes as fast as it usually flies."""
    rig, (one, two) = coming(tmp_path, slowest=5.0)
    here = waiting(rig, one)
    rig.tell(behind(two, 1_000, 0.0144), here, here.copy(Time=1_500))
    circles = [c.VehicleActionList[0] for c in rig.got("VehicleActionCommand") if c.VehicleID == 1]
    assert [a.Airspeed for a in circles] == pytest.approx([20.0, 10.0])
    tightest_m = 1.1 * 10**2 / (9.80665 * math.tan(math.radians(30)))
    assert [a.Radius for a in circles] == pytest.approx([tightest_m] * 2)


def test_a_lap_is_waited_at_the_usual_speed_where_the_wind_makes_that_the_shorter_one() -> None:
    flyer, limits = Flyer(20.0, 80.0, 300.0, 3.0, ()), Limits(12.0, 20.0, 27.0, 30.0)
    assert waiting_of(flyer, limits, Vec2(0.0, 0.0))[:2] == pytest.approx((12.0, 28.8))
    assert waiting_of(flyer, limits, Vec2(11.5, 0.0)) is flyer
    assert waiting_of(flyer, Limits(20.0, 20.0, 20.0, 20.0), Vec2(0.0, 0.0))[:2] == flyer[:2]


def left(rig: Any) -> list[int]:
    """Who was sent along its run-in or on."""
    return [
        command.VehicleID
        for command in rig.got("VehicleActionCommand")
        for action in command.VehicleActionList
        if type(action).__name__ == "GoToWaypointAction"
    ]


def test_who_is_late_moves_the_common_time_on(tmp_path: Path) -> None:
    rig, (one, two) = coming(tmp_path)
    here = waiting(rig, one)
    for time_ms in range(1_000, 400_000, 20_000):  # it does not get on
        rig.tell(behind(two, time_ms, 0.05), here.copy(Time=time_ms))
    assert not rig.reasons("Warning")
    assert not left(rig)


def test_a_plan_without_one_of_them_ends_it_for_all(tmp_path: Path) -> None:
    rig, _ = under_way(tmp_path)
    plan = rig.got("AutomationResponse")[-1]
    other = next(c for c in plan.MissionCommandList if c.VehicleID == 2)
    bare = [w.copy(AssociatedTasks=[]) for w in other.WaypointList]
    rig.tell(plan.copy(MissionCommandList=[other.copy(WaypointList=bare)]))
    assert any("a plan without it came" in text for text in rig.reasons("Warning"))


def test_who_has_passed_flies_on_at_its_own_speed(tmp_path: Path) -> None:
    rig, (one, two) = under_way(tmp_path)
    rig.tell(behind(two, 20_000, 0.0028), one.copy(Location=place(0.0372), Time=20_000))
    rig.tell(behind(two, 33_900, 0.0001), one.copy(Location=place(0.0399), Time=33_900))
    rig.tell(one.copy(Location=place(0.0401), Time=34_400))
    last = rig.got("VehicleActionCommand")[-1]
    assert (last.VehicleID, last.VehicleActionList[0].Speed) == (1, 20.0)


def test_who_evades_has_not_left_it(tmp_path: Path) -> None:
    """While ICAROUS has a vehicle its states say nothing of the task."""
    rig, (_, two) = under_way(tmp_path)
    rig.tell(lmcp.new("AuthorityChange", VehicleID=2, Owner="ICAROUS"))
    rig.tell(two.copy(AssociatedTasks=[], Time=2_000))
    assert not rig.reasons("Warning")
    rig.tell(lmcp.new("AuthorityChange", VehicleID=2, Owner="UxAS"))
    rig.tell(two.copy(AssociatedTasks=[], Time=3_000))
    assert any("vehicle 2 flies it no more" in text for text in rig.reasons("Warning"))
