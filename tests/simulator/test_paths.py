"""Paths in the simulator: once, in a loop, there and back again, from one time to another, driven and flown."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import pytest
from driving_tools import LAT, at, hover, mission, order, path, vehicle
from simulator_tools import scenario

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.world import Event, World

SQUARE = ((40.0, 0.0), (40.0, 40.0), (0.0, 0.0))


def driven(*orders: tuple[float, Any], seconds: float) -> list[Any]:
    events = [Event(0.0, body, "") for body in vehicle()]
    world, told = World([*events, *(Event(t, b, "") for t, b in orders)], seconds), list[Any]()
    while not world.over:
        told += [b for b in world.tick() if type(b).__name__ == "GroundVehicleState"]
    assert world.warnings() == []
    return told[1:]


def stretches(states: Sequence[Any]) -> list[int]:
    """The waypoints that are gone to, one after the other."""
    return [n for n, _ in itertools.groupby(s.CurrentWaypoint for s in states)]


def moving(states: Sequence[Any]) -> list[int]:
    return [s.Time for s in states if s.Groundspeed > 0]


def test_a_path_is_driven_with_its_pauses_once_or_in_a_loop() -> None:
    once = driven((0.5, path(*SQUARE)), seconds=90.0)
    stood = [s.Time for s in once if s.CurrentWaypoint == 2 and s.Groundspeed == 0]
    assert 8_500 <= stood[-1] - stood[0] <= 10_000
    assert (once[-1].CurrentWaypoint, once[-1].Groundspeed, once[-1].CurrentCommand) == (3, 0, 7)
    assert once[-1].Mode.name == "Waypoint"
    loop = driven((0.5, path(*SQUARE, RepeatMode="Loop")), seconds=90.0)
    assert stretches(loop)[:6] == [0, 1, 2, 3, 1, 2]
    world = World((), 10)
    for body in (*vehicle(), path(*SQUARE, VehicleID=2)):
        world.receive(body)
    assert world.unheard == {"FollowPathCommand": 1}, "of a vehicle that is not there"


def test_there_and_back_again_the_waypoints_keep_their_numbers() -> None:
    back = path((40.0, 0.0), (40.0, 40.0), (60.0, 40.0), (60.0, 80.0), RepeatMode="ReverseCourse")
    states = driven((0.5, back), seconds=150.0)
    assert stretches(states)[:10] == [0, 1, 2, 3, 4, 3, 2, 1, 2, 3]
    stood = [s.Time for s in states if s.CurrentWaypoint == 2 and s.Groundspeed == 0]
    pauses = [b - a for a, b in itertools.pairwise(stood) if b - a > 5000]
    assert len(pauses) >= 1, "on the way back as well"
    two = driven((0.5, path((40.0, 0.0), (80.0, 0.0), RepeatMode="ReverseCourse")), seconds=80.0)
    assert stretches(two)[:5] == [0, 1, 2, 1, 2]
    one = driven((0.5, path((40.0, 0.0), RepeatMode="ReverseCourse")), seconds=20.0)
    assert one[-1].Groundspeed == 0
    first, middle, last = path((9.0, 0.0), (18.0, 0.0), (27.0, 0.0)).WaypointList
    highest = 2**63 - 1  # no number is above it
    ways = [first, middle.copy(PauseTime=0, NextWaypoint=highest), last.copy(Number=highest)]
    later = path(RepeatMode="ReverseCourse", StartTime=2000, WaypointList=ways)
    assert stretches(driven((0.5, later), seconds=40.0))[:6] == [0, 1, 2, highest, 2, 1]


def test_it_begins_and_ends_at_the_times_that_are_given() -> None:
    timed = path((900.0, 0.0), StartTime=10_000, StopTime=30_000)
    states = driven((1.0, timed), seconds=60.0)
    times = moving(states)
    assert 10_000 <= times[0] <= 11_000
    assert 30_000 < times[-1] < 39_500, "it brakes from then on"
    last = states[-1]
    assert (last.Mode.name, last.CurrentCommand, last.Groundspeed) == ("Loiter", 7, 0)
    assert last.Location.Latitude < LAT + 200 / 111_195, "no farther than it has to"
    later = driven((1.0, timed), (5.0, mission((50.0, 0.0))), seconds=45.0)
    assert moving(later)[0] < 6000, "the mission that it is told since"
    assert later[-1].Location.Latitude == pytest.approx(at(50.0, 0.0)["Latitude"], abs=1e-5)
    stand = driven((1.0, timed), (15.0, order(hover(0, 0, 0))), seconds=45.0)
    assert stand[-1].Location.Latitude == pytest.approx(LAT, abs=1e-5)
    slow = order(lmcp.new("SpeedOverrideAction", Speed=5.0))
    assert len(moving(driven((1.0, timed), (15.0, slow), seconds=45.0))) > 30, "it still ends"
    gone = lmcp.new("RemoveEntities", EntityList=[1])
    assert driven((1.0, timed), (5.0, gone), seconds=15.0)[-1].Time <= 5000
    past = driven((40.0, timed), seconds=60.0)
    assert past[-1].Location.Latitude == pytest.approx(LAT, abs=1e-5)


def flown(*orders: tuple[float, Any], seconds: float, compatible: bool = False) -> list[Any]:
    plan = of_text(scenario(), "test")
    more = [Event(time_s, body, "") for time_s, body in orders]
    world, told = World([*plan.events, *more], seconds, compatible=compatible), list[Any]()
    while not world.over:
        told += [b for b in world.tick() if type(b).__name__ == "AirVehicleState" and b.Time]
    assert world.unheard == ({"FollowPathCommand": 1} if compatible else {})
    return told


def airway(**more: Any) -> Any:
    """Three places 1.5 km apart, north of where the aircraft is, with a pause of two minutes at the second one."""
    ways = [
        lmcp.new("PathWaypoint", Number=k, NextWaypoint=k + 1, PauseTime=120_000 * (k == 2),
                 Latitude=45 + 0.0135 * k, Longitude=-120.0, Altitude=400.0, Speed=22.0)
        for k in (1, 2, 3)
    ]  # fmt: skip
    values = {"CommandID": 7, "VehicleID": 1, "FirstWaypoint": 1, "WaypointList": ways, **more}
    return lmcp.new("FollowPathCommand", **values)


def away_m(state: Any, lat: float) -> float:
    here = state.Location
    return math.hypot((here.Latitude - lat) * 111_200, (here.Longitude + 120) * 78_600)


def test_an_aircraft_flies_a_path_circles_in_its_pauses_and_at_its_end() -> None:
    states = flown((1.0, airway()), seconds=500.0)
    assert stretches(states) == [0, 1, 2, 3]
    paused = [s for s in states if s.Mode.name == "Loiter" and s.CurrentWaypoint == 2]
    assert 115_000 < paused[-1].Time - paused[0].Time < 125_000
    assert max(away_m(s, 45.027) for s in paused) < 450
    last = states[-1]
    assert (last.Mode.name, last.CurrentCommand) == ("Loiter", 7)
    assert max(away_m(s, 45.0405) for s in states[-100:]) < 300
    assert stretches(flown((1.0, airway()), seconds=60.0, compatible=True)) == [0]


def test_an_aircraft_flies_there_and_back_until_it_is_to_end() -> None:
    (one, two, three) = airway().WaypointList
    there = airway(RepeatMode="ReverseCourse", WaypointList=[one, two.copy(PauseTime=0), three],
                   StartTime=20_000, StopTime=450_000)  # fmt: skip
    states = flown((1.0, there), seconds=550.0)
    assert stretches(states)[:6] == [0, 1, 2, 3, 2, 1]
    begun = next(s.Time for s in states if s.CurrentWaypoint == 1)
    assert 20_000 <= begun <= 20_600
    modes = {s.Time: s.Mode.name for s in states}
    assert modes[max(t for t in modes if t < 450_000)] == "Waypoint"
    assert {mode for t, mode in modes.items() if t > 451_000} == {"Loiter"}
    end = next(s.Location for s in states if s.Time > 450_000)
    for state in states[-100:]:
        assert math.hypot((state.Location.Latitude - end.Latitude) * 111_200,
                          (state.Location.Longitude - end.Longitude) * 78_600) < 400  # fmt: skip


def test_a_scenario_may_begin_later(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    text = scenario().replace("</ScenarioDuration>", "</ScenarioDuration>{}")
    start = "<ScenarioStartTime>{}</ScenarioStartTime>"
    early = order(lmcp.new("FlightDirectorAction", Heading=90.0, Speed=22.0))
    late = order(lmcp.new("FlightDirectorAction", Heading=180.0, Speed=22.0))

    def told(begins: str) -> list[Any]:
        plan = of_text(text.format(begins), "test")
        events = [*plan.events, Event(90.0, early, ""), Event(130.0, late, "")]
        world, found = World(events, 60.0, start_s=plan.start_s), list[Any]()
        while not world.over:
            found += world.tick()
        assert world.time_s == pytest.approx(plan.start_s + 60, abs=0.02)
        return found

    bodies = told(start.format(100))
    assert [type(b).__name__ for b in bodies[:3]] == [
        "AirVehicleConfiguration", "AirVehicleState", "VehicleActionCommand",
    ]  # fmt: skip
    times = [b.ScenarioTime for b in bodies if type(b).__name__ == "SessionStatus"]
    assert 100_500 <= times[0] <= 100_600
    assert len(times) > 110
    states = [b for b in bodies if type(b).__name__ == "AirVehicleState" and b.Time]
    assert {s.Time for s in states} == set(times)
    headings = {s.Time: s.Heading for s in states}
    assert headings[times[40]] == pytest.approx(90, abs=1)
    assert abs(headings[times[-1]]) == pytest.approx(180, abs=1)
    assert told(start.format(0)) == told("")
    (tmp_path / "s.xml").write_text(text.format(start.format(50)))
    assert main(["sim", str(tmp_path / "s.xml"), "--until", "5"]) == 0
    got = capsys.readouterr()
    assert "5 s of 1 aircraft" in got.out
    assert got.err == ""
    (tmp_path / "s.xml").write_text(text.format(start.format("1e12")))
    assert main(["sim", str(tmp_path / "s.xml")]) == 2
    assert "ScenarioStartTime" in capsys.readouterr().err
