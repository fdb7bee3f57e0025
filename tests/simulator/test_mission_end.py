"""A MissionCommand without waypoints in the simulator: the vehicle's mission is over, and it stays where it is."""

from __future__ import annotations

import math
from typing import Any

import driving_tools as driving
from simulator_tools import scenario

from cratous.bridge import lmcp
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.world import Event, World

OVER = lmcp.new("MissionCommand", CommandID=9, VehicleID=1)


def mission(*actions: Any) -> Any:
    """To two places north, 3 and 30 km away; actions: at the first."""
    ways = [
        lmcp.new("Waypoint", Number=k, NextWaypoint=2, Latitude=45 + d, Longitude=-120.0, Altitude=400.0,
                 Speed=22.0, AssociatedTasks=[5], VehicleActionList=list(actions) if k == 1 else [])
        for k, d in ((1, 0.027), (2, 0.27))
    ]  # fmt: skip
    return lmcp.new("MissionCommand", CommandID=7, VehicleID=1, FirstWaypoint=1, WaypointList=ways)


def circle(latitude: float, seconds: int) -> Any:
    place = lmcp.new("Location3D", Latitude=latitude, Longitude=-120.0, Altitude=400.0)
    return lmcp.new(
        "LoiterAction", LoiterType="Circular", Radius=300.0, Duration=1000 * seconds, Airspeed=22.0,
        Location=place,
    )  # fmt: skip


def flown(*orders: tuple[float, Any], seconds: float, compatible: bool = False) -> list[Any]:
    more = [Event(time_s, body, "") for time_s, body in orders]
    world = World([*of_text(scenario(), "test").events, *more], seconds, compatible=compatible)
    told = list[Any]()
    while not world.over:
        told += [b for b in world.tick() if type(b).__name__ == "AirVehicleState" and b.Time]
    return told


def apart_m(a: Any, b: Any) -> float:
    north, east = a.Latitude - b.Latitude, a.Longitude - b.Longitude
    return math.hypot(111_200 * north, 78_600 * east)


def test_an_aircraft_on_its_way_circles_where_it_is_and_lists_no_task() -> None:
    states = flown((1.0, mission()), (60.0, OVER), seconds=300.0)
    here = next(s for s in states if s.Time >= 60_000)
    after = [s for s in states if s.Time > 61_000]
    assert {s.Mode.name for s in after} == {"Loiter"}
    assert not any(s.AssociatedTasks for s in after)
    assert {s.CurrentCommand for s in after} == {9}
    assert max(apart_m(s.Location, here.Location) for s in after) < 800
    assert any(s.AssociatedTasks for s in states if s.Time < 60_000)


def test_an_aircraft_that_circles_for_a_while_does_not_resume_its_plan() -> None:
    waits = circle(45.027, 60)
    resumed = flown((1.0, mission(waits)), seconds=400.0)
    assert resumed[-1].Mode.name == "Waypoint", "without the command it does"
    states = flown((1.0, mission(waits)), (160.0, OVER), seconds=400.0)
    after = [s for s in states if s.Time > 161_000]
    assert {s.Mode.name for s in after} == {"Loiter"}
    assert max(apart_m(s.Location, waits.Location) for s in after) < 450, "the same circle"
    assert not any(s.AssociatedTasks for s in after)


def test_a_mission_that_is_over_has_no_waypoint_to_go_to_and_another_begins_afresh() -> None:
    go = lmcp.new("GoToWaypointAction", WaypointNumber=2)
    order = lmcp.new("VehicleActionCommand", CommandID=10, VehicleID=1, VehicleActionList=[go])
    states = flown((1.0, mission()), (60.0, OVER), (80.0, order), seconds=120.0)
    assert states[-1].Mode.name == "Loiter"
    again = flown((1.0, mission()), (60.0, OVER), (80.0, mission()), seconds=120.0)
    assert (again[-1].Mode.name, again[-1].CurrentCommand) == ("Waypoint", 7)


def test_where_the_faults_of_amase_are_kept_the_command_changes_nothing() -> None:
    both = [
        flown((1.0, mission()), *more, seconds=90.0, compatible=True)
        for more in ((), ((60.0, OVER),))
    ]
    assert both[0] == both[1]


def test_what_drives_brakes_and_stands() -> None:
    events = [Event(0.0, body, "") for body in driving.vehicle()]
    plan = driving.mission((900.0, 0.0))
    world, told = World([*events, Event(1.0, plan, ""), Event(20.0, OVER, "")], 60.0), list[Any]()
    while not world.over:
        told += [b for b in world.tick() if type(b).__name__ == "GroundVehicleState"]
    here = next(s for s in told if s.Time >= 20_000)
    last = told[-1]
    assert (last.Mode.name, last.Groundspeed, list(last.AssociatedTasks)) == ("Loiter", 0, [])
    assert 0 < apart_m(last.Location, here.Location) < 40, "no farther than it has to"
