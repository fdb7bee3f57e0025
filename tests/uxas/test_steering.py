"""SteeringService: an aircraft that takes courses alone flies a plan, and what is told of it."""

from __future__ import annotations

from math import atan, cos, degrees, hypot, pi, radians, sin, tan
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pipeline_messages import response
from pipeline_tools import Rig, place, request, vehicle

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.services.uxas.courses import EARTH_M, circle_course, line_course, passed, plane

STEERING = "SteeringService"
DEGREE_M = radians(1) * EARTH_M


def plan(*points: tuple[float, float], last: dict[str, Any] | None = None, **more: Any) -> Any:
    """A mission over places [deg], each waypoint with the task of its number."""
    ways = [
        lmcp.new(
            "Waypoint", Number=k, NextWaypoint=min(k + 1, len(points)), Latitude=p[0], Longitude=p[1],
            Altitude=300.0, Speed=20.0, AssociatedTasks=[k],
            **(last or {} if k == len(points) else {}),
        )
        for k, p in enumerate(points, 1)
    ]  # fmt: skip
    return lmcp.new("MissionCommand", VehicleID=1, FirstWaypoint=1, WaypointList=ways, **more)


class Flown:
    """An aircraft that turns as fast as it can onto the course that it is told, 20 m/s, 30 degrees of bank."""

    def __init__(self, folder: Path, attributes: str = "") -> None:
        self.rig = Rig(folder, STEERING, **{STEERING: f'VehicleID="1" {attributes}'})
        self.rig.tell(vehicle(1)[0])
        self.at, self.heading = Vec2(0.0, 0.0), 0.0
        self.track: list[Vec2] = []

    def state(self) -> Any:
        where = place(self.at.x / DEGREE_M, self.at.y / DEGREE_M)
        return lmcp.new(
            "AirVehicleState", ID=1, Location=where, Heading=degrees(self.heading) % 360
        )

    def step(self, wait_ms: int = 500) -> None:
        self.rig.bus.publish(self.state(), "test", address="PartialAirVehicleState")
        self.rig.bus.run()
        told = self.rig.got("VehicleActionCommand")
        if told:
            off = radians(told[-1].VehicleActionList[0].Heading) - self.heading
            off = (off + pi) % (2 * pi) - pi
            most = 9.80665 * tan(radians(30)) / 20 * wait_ms / 1000
            self.heading += max(-most, min(most, off))
        step = 20.0 * wait_ms / 1000
        self.at = Vec2(self.at.x + step * cos(self.heading), self.at.y + step * sin(self.heading))
        self.track.append(self.at)
        self.rig.wait(wait_ms)


@pytest.mark.shows(
    STEERING,
    "AutomationResponse",
    "AirVehicleConfiguration",
    "PartialAirVehicleState",
    "VehicleActionCommand",
    "AirVehicleState",
    "VehicleID",
)
def test_a_plan_is_flown_and_its_tasks_are_told(tmp_path: Path) -> None:
    one = Flown(tmp_path)
    one.step()
    assert not one.rig.got("VehicleActionCommand"), "without a plan it says nothing"
    corners = [(0.02, 0.0), (0.02, 0.02), (0.0, 0.02)]
    one.rig.tell(response(plan(*corners), plan((0.5, 0.5)).copy(VehicleID=2)))
    for _ in range(700):
        one.step()
        told = one.rig.got("AirVehicleState", STEERING)[-1]
        if told.CurrentWaypoint == 3 and one.at.x < -50:
            break
    else:
        pytest.fail("it has not come to the last waypoint")
    tasks = [tuple(s.AssociatedTasks) for s in one.rig.got("AirVehicleState", STEERING)]
    assert list(dict.fromkeys(tasks)) == [(), (1,), (2,), (3,)]
    passed_by = len(one.track)
    for _ in range(300):
        one.step()
    away = [hypot(p.x, p.y - 0.02 * DEGREE_M) for p in one.track[passed_by:]]
    assert max(away) < 300, "it stays about the last one"
    middle = [p for p in one.track if 800 < p.y < 1500 and p.x > 1000]
    assert max(abs(p.x - 0.02 * DEGREE_M) for p in middle) < 60, "along the second leg"
    first = one.rig.got("VehicleActionCommand")[0]
    action = first.VehicleActionList[0]
    assert (first.VehicleID, first.CommandID, first.Status.name) == (1, 1, "Approved")
    assert (action.Speed, action.Altitude, action.Heading) == (20.0, 300.0, pytest.approx(0.0))


@pytest.mark.shows(STEERING, "MissionCommand")
@pytest.mark.parametrize("direction", ["Clockwise", "CounterClockwise"])
def test_a_loiter_is_circled_and_left_when_its_time_is_over(tmp_path: Path, direction: str) -> None:
    loiter = lmcp.new(
        "LoiterAction", Radius=300.0, Direction=direction, Duration=200_000, Airspeed=18.0,
        Location=place(0.01),
    )  # fmt: skip
    one = Flown(tmp_path)
    mission = plan((0.01, 0.0), (0.05, 0.0))
    mission.WaypointList[0].VehicleActionList.append(loiter)
    one.rig.tell(mission)
    for _ in range(400):
        one.step()
    speeds = {c.VehicleActionList[0].Speed for c in one.rig.got("VehicleActionCommand")}
    assert speeds == {18.0}
    late = one.track[200:]
    assert all(abs(hypot(p.x - 0.01 * DEGREE_M, p.y) - 300) < 30 for p in late)
    a, b = (Vec2(p.x - 0.01 * DEGREE_M, p.y) for p in late[:2])
    assert (a.x * b.y - a.y * b.x > 0) == (direction == "Clockwise")
    one.step()
    assert one.rig.got("AirVehicleState", STEERING)[-1].CurrentWaypoint == 2


@pytest.mark.shows(STEERING, "KOrbit")
@pytest.mark.parametrize(("attributes", "inwards_deg"), [("", 45.0), ('KOrbit="0.01"', 0.573)])
def test_how_steeply_a_circle_is_met(tmp_path: Path, attributes: str, inwards_deg: float) -> None:
    """With the gain of UxAS it hardly turns inwards at twice the radius."""
    one = Flown(tmp_path, attributes)
    mission = plan((0.01, 0.0))
    mission.WaypointList[0].VehicleActionList.append(
        lmcp.new(
            "LoiterAction", Radius=300.0, Direction="Clockwise", Duration=-1, Location=place(0.01)
        )
    )
    one.rig.tell(mission)
    one.at = Vec2(0.01 * DEGREE_M, 600.0)  # due east of it: clockwise is south, inwards is west
    one.step()
    heading = one.rig.got("VehicleActionCommand")[0].VehicleActionList[0].Heading
    assert heading % 360 == pytest.approx(180 + inwards_deg, abs=0.1)


@pytest.mark.shows(STEERING, "SpeedOverrideAction")
def test_a_speed_that_is_told_counts_until_the_next_plan(tmp_path: Path) -> None:
    one = Flown(tmp_path)
    one.rig.tell(plan((0.02, 0.0)))
    for body in (None, lmcp.new("SpeedOverrideAction", VehicleID=1, Speed=24.0), plan((0.02, 0.0))):
        if body is not None:
            one.rig.tell(body)
        one.step()
    told = [c.VehicleActionList[0].Speed for c in one.rig.got("VehicleActionCommand")]
    assert told == [20.0, 24.0, 20.0]


@pytest.mark.shows(STEERING, "VehicleActionCommand")
def test_while_a_task_steers_it_is_silent(tmp_path: Path) -> None:
    one = Flown(tmp_path)
    one.rig.tell(plan((0.02, 0.0)))
    camera = lmcp.new("GimbalAngleAction", PayloadID=1)
    steer = lmcp.new("FlightDirectorAction", Heading=90.0)
    counts = []
    for actions, number in ((camera, 1), (steer, 2), (steer, 1)):
        command = lmcp.new("VehicleActionCommand", VehicleID=number, VehicleActionList=[actions])
        one.rig.tell(command)
        one.step()
        counts.append(len(one.rig.got("VehicleActionCommand", STEERING)))
    assert counts == [1, 2, 2]
    assert len(one.rig.got("AirVehicleState", STEERING)) == 3, "states go on"
    one.rig.tell(plan((0.02, 0.0)))
    one.step()
    assert len(one.rig.got("VehicleActionCommand", STEERING)) == 3, "until the next plan"


@pytest.mark.shows(
    STEERING,
    "UseSafeHeadingAction",
    "OverrideRegion",
    "SafeHeadingAction",
    "UniqueAutomationRequest",
    "UniqueAutomationResponse",
)
@pytest.mark.parametrize(("attributes", "region"), [("", 7), ('OverrideRegion="9"', 9)])
def test_courses_go_to_the_leash_in_the_region_of_the_plan(
    tmp_path: Path, attributes: str, region: int
) -> None:
    one = Flown(tmp_path, f'UseSafeHeadingAction="TRUE" {attributes}')
    for number, of, sandbox in ((4, 7, False), (5, 8, True)):
        asked = lmcp.new(
            "UniqueAutomationRequest", RequestID=number, SandBoxRequest=sandbox,
            OriginalRequest=request(1, OperatingRegion=of),
        )  # fmt: skip
        one.rig.tell(asked)
    answer = response(plan((0.0, 0.02)))
    for number in (4, 5):  # the second answers a trial, which is not flown
        one.rig.tell(
            lmcp.new("UniqueAutomationResponse", ResponseID=number, OriginalResponse=answer)
        )
    one.rig.tell(answer)
    one.step()
    (action,) = one.rig.got("SafeHeadingAction")
    assert not one.rig.got("VehicleActionCommand")
    turn = 20**2 / 9.80665 / tan(radians(30))
    assert action.OperatingRegion == region
    assert action.LoiterRadius == pytest.approx(1.2 * turn, rel=1e-6)
    assert action.LeadAheadDistance == pytest.approx(3.6 * turn, rel=1e-6)
    assert (action.DesiredHeading, action.Speed, action.Altitude) == (
        pytest.approx(90.0, abs=1e-3), 20.0, 300.0
    )  # fmt: skip
    assert (action.UseSpeed, action.UseAltitude, action.UseHeadingRate) == (True, True, False)


@pytest.mark.shows(STEERING, "AcceptanceTime_ms")
@pytest.mark.parametrize(("kind", "number"), [("TurnShort", 2), ("FlyOver", 1)])
def test_turns_may_begin_before_a_waypoint(tmp_path: Path, kind: str, number: int) -> None:
    one = Flown(tmp_path, 'AcceptanceTime_ms="60000"')
    mission = plan((0.01, 0.0), (0.01, 0.03))
    mission.WaypointList[0] = mission.WaypointList[0].copy(TurnType=kind)
    one.rig.tell(mission)
    one.step()
    assert one.rig.got("AirVehicleState", STEERING)[0].CurrentWaypoint == number


@pytest.mark.shows(STEERING, "MaxCourseAngleDeg", "KLine")
def test_how_steeply_a_line_is_met(tmp_path: Path) -> None:
    one = Flown(tmp_path, 'MaxCourseAngleDeg="30" KLine="0.005"')
    mission = plan((0.02, 0.0), (-0.02, 0.0))  # the leg to the first one begins at the second
    mission.WaypointList[1].NextWaypoint = 1
    one.rig.tell(mission)
    one.at = Vec2(0.0, 400.0)
    one.step()
    heading = one.rig.got("VehicleActionCommand")[0].VehicleActionList[0].Heading
    assert heading == pytest.approx(-60 / pi * atan(2.0), abs=0.01)


def test_a_cycle_of_near_waypoints_and_a_state_without_a_place_have_an_end(tmp_path: Path) -> None:
    one = Flown(tmp_path)
    mission = plan((0.0, 0.0), (0.0, 0.0))
    mission.WaypointList[1].NextWaypoint = 1
    one.rig.tell(mission)
    one.step()
    nowhere = one.state()
    nowhere.Location.Latitude = float("nan")
    one.rig.bus.publish(nowhere, "test", address="PartialAirVehicleState")
    one.rig.tell(plan(), mission.copy(FirstWaypoint=77))
    one.step()
    assert len(one.rig.got("AirVehicleState", STEERING)) == 3
    assert not one.rig.reasons()


REACH = st.floats(-1e5, 1e5)
SPOT = st.tuples(REACH, REACH).map(lambda p: Vec2(*p))


@given(SPOT, SPOT, SPOT, st.floats(0.05, pi / 2), st.floats(1e-4, 1.0))
def test_a_line_is_met_from_both_sides(
    here: Vec2, start: Vec2, to: Vec2, most: float, gain: float
) -> None:
    """The course crosses the line by at most that angle, towards it; on it, it is the line's."""
    along = Vec2(to.x - start.x, to.y - start.y)
    if hypot(*along) < 1:
        return
    course = line_course(here, start, to, most, gain)
    right = (along.x * sin(course) - along.y * cos(course)) / hypot(*along)  # share to the right
    off = (along.x * (here.y - start.y) - along.y * (here.x - start.x)) / hypot(*along)
    assert abs(right) <= sin(most) + 1e-6
    assert right * off <= 1e-6 * (1 + abs(off))
    assert along.x * cos(course) + along.y * sin(course) >= -1e-6 * hypot(*along)


@given(SPOT, st.floats(50, 5000), st.booleans(), st.floats(0.01, 10))
def test_a_circle_is_met_from_inside_and_outside(
    here: Vec2, radius: float, clockwise: bool, gain: float
) -> None:
    apart = hypot(*here)
    if apart < 1:
        return
    course = circle_course(here, Vec2(0.0, 0.0), radius, clockwise, gain)
    outwards = (here.x * cos(course) + here.y * sin(course)) / apart
    around = (here.x * sin(course) - here.y * cos(course)) / apart
    assert outwards * (apart - radius) <= 1e-6 * (1 + abs(apart - radius))
    assert (around >= -1e-9) if clockwise else (around <= 1e-9)


def test_places_near_each_other_and_across_the_date_line() -> None:
    at = plane(10.0, -179.999, (10.0, 179.999))
    assert at.x == 0
    assert at.y == pytest.approx(0.002 * DEGREE_M * cos(radians(10)), rel=1e-9)
    assert passed(Vec2(1.0, 0.0), Vec2(-5.0, 0.0), Vec2(0.0, 0.0))
    assert not passed(Vec2(-1.0, 9.0), Vec2(-5.0, 0.0), Vec2(0.0, 0.0))


@pytest.mark.parametrize(
    "wrong",
    [
        {"Latitude": float("inf")},
        {"Longitude": float("nan")},
        {"Speed": float("nan")},
        {"VehicleActionList": [lmcp.new("LoiterAction", Radius=float("nan"), Duration=-1)]},
    ],
)
def test_a_plan_whose_numbers_lead_nowhere_is_not_flown(
    tmp_path: Path, wrong: dict[str, Any]
) -> None:
    one = Flown(tmp_path)
    good = plan((0.0, 0.02), (0.02, 0.02))
    first, *rest = good.WaypointList
    bad = good.copy(WaypointList=[first.copy(**wrong), *rest])
    one.rig.tell(response(bad))
    one.step()
    assert not one.rig.got("VehicleActionCommand")
    assert len(one.rig.got("AirVehicleState", STEERING)) == 1
    one.rig.tell(response(good), response(bad))
    one.step()
    (told,) = one.rig.got("VehicleActionCommand")
    assert told.VehicleActionList[0].Heading == pytest.approx(90.0, abs=0.5)
