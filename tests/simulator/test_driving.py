"""What drives or sails in the simulator: its ways, its limits, what it is told and what it refuses."""

from __future__ import annotations

import contextlib
import itertools
import math
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from driving_tools import at, hover, mission, order, vehicle
from uxas_flight import across_m, local
from uxas_tools import Client

from cratous.bridge import lmcp
from cratous.bridge.port import address
from cratous.core.kernel import Vec2
from cratous.services.cli import main
from cratous.services.simulator.server import Server
from cratous.services.simulator.world import Event, World
from cratous.spec.errors import BadInput


def driven(vehicle: Sequence[Any], *orders: tuple[float, Any], seconds: float) -> list[Any]:
    """The states of a vehicle that is told these at their times."""
    events = [Event(0.0, body, "") for body in vehicle]
    events += [Event(time_s, body, "") for time_s, body in orders]
    world, told = World(events, seconds), list[Any]()
    while not world.over:
        told += [b for b in world.tick() if type(b).__name__.endswith("VehicleState")]
    return told[1:]  # the first one is the event


def track(states: Sequence[Any]) -> list[Vec2]:
    return local([s.Location for s in states], lmcp.new("Location3D", **at(0, 0)))


@pytest.mark.parametrize(
    ("kind", "brakes", "off_m", "long"), [("Ground", 1.0, 1.5, 1.0), ("Surface", 0.5, 11.0, 2.0)]
)
def test_a_way_with_corners_is_driven_within_limits_and_ends_at_a_stand(
    kind: str, brakes: float, off_m: float, long: float
) -> None:
    ways = [(150.0, 0.0), (150.0, 120.0), (150.0, 0.0), (250.0, 40.0)]
    places = [(long * north, long * east) for north, east in ways]
    states = driven(vehicle(kind, MaxBankAngle=8.0, MaxBankRate=10.0) if kind == "Surface"
                    else vehicle(), (1.0, mission(*places, Speed=30.0)), seconds=240.0)  # fmt: skip
    path = [Vec2(0, 0), *(Vec2(*p) for p in places)]
    assert max(across_m(track(states), path)) < off_m
    for corner in places:
        assert min(math.dist(corner, p) for p in track(states)) < off_m + 4, "passed closely"
    speeds = [s.Groundspeed for s in states]
    assert max(speeds) == pytest.approx(12.0), "as fast as it can, and no faster"
    for one, two in itertools.pairwise(states):
        assert abs(two.Groundspeed - one.Groundspeed) < brakes * (two.Time - one.Time) / 1000 + 0.1
        assert abs(two.Groundspeed * math.radians(two.r)) < 2.1
    last = states[-1]
    assert speeds[-1] == 0
    assert math.dist(track(states)[-1], places[-1]) < 0.3
    assert (last.CurrentWaypoint, last.CurrentCommand, last.Mode.name) == (4, 7, "Waypoint")
    assert list(last.AssociatedTasks) == [4]
    assert {s.CurrentWaypoint for s in states} == {0, 1, 2, 3, 4}
    if kind == "Surface":
        assert 4 < max(abs(s.BankAngle) for s in states) < 8.1
        assert last.Speed == 0


def test_the_same_is_driven_again_and_a_loop_goes_on() -> None:
    ways = mission((80.0, 0.0), (80.0, 80.0), (0.0, 0.0))
    loop = ways.copy(
        WaypointList=[w.copy(NextWaypoint=w.Number % 3 + 1) for w in ways.WaypointList]
    )
    one, two = (driven(vehicle(), (0.5, loop), seconds=200.0) for _ in range(2))
    assert [lmcp.binary.pack(s) for s in one] == [lmcp.binary.pack(s) for s in two]
    numbers = [n for n, _ in itertools.groupby(s.CurrentWaypoint for s in one)]
    assert numbers[:8] == [0, 1, 2, 3, 1, 2, 3, 1]


def test_it_stands_at_a_waypoint_for_as_long_as_is_asked() -> None:
    ways = mission((60.0, 0.0), (120.0, 0.0), stand=1, actions=[hover(60, 0, 20_000)])
    states = driven(vehicle(), (0.5, ways), seconds=80.0)
    stood = [
        s.Time for s in states if s.CurrentWaypoint == 1 and s.Groundspeed == 0 and s.Time > 5e3
    ]
    assert 19_000 <= stood[-1] - stood[0] <= 21_000
    assert [s.Mode.name for s in states if s.Time in stood[2:-1]] == ["Loiter"] * (len(stood) - 3)
    assert all(list(s.AssociatedTasks) == [1] for s in states if s.Time in stood)
    assert track(states)[-1] == pytest.approx((120.0, 0.0), abs=0.3)


def test_a_stand_for_ever_ends_by_command_and_one_by_command_goes_there() -> None:
    ways = mission((60.0, 0.0), (120.0, 0.0), stand=1, actions=[hover(60, 0, -1)])
    on = order(lmcp.new("GoToWaypointAction", WaypointNumber=2))
    states = driven(
        vehicle(), (0.5, ways), (60.0, on), (90.0, order(hover(120, 50, 0))), seconds=130.0
    )
    before = [s for s in states if 30_000 < s.Time < 60_000]
    assert {(s.Groundspeed, s.CurrentWaypoint, s.CurrentCommand) for s in before} == {(0, 1, 7)}
    assert {s.CurrentWaypoint for s in states if 61_000 < s.Time < 90_000} == {2}
    last = states[-1]
    assert (last.Mode.name, last.CurrentCommand, last.Groundspeed) == ("Loiter", 8, 0)
    assert list(last.AssociatedTasks) == []
    assert track(states)[-1] == pytest.approx((120.0, 50.0), abs=0.3)


def test_speed_and_course_are_taken_by_command() -> None:
    director = lmcp.new("FlightDirectorAction", Heading=90.0, Speed=5.0)
    slow = order(lmcp.new("SpeedOverrideAction", Speed=3.0))
    nowhere = order(lmcp.new("GoToWaypointAction", WaypointNumber=99))
    states = driven(vehicle(), (0.5, mission((900.0, 0.0))), (20.0, slow), (30.0, nowhere),
                    (40.0, order(director)), seconds=70.0)  # fmt: skip
    assert {round(s.Groundspeed, 3) for s in states if 12_000 < s.Time < 20_000} == {8}
    assert {round(s.Groundspeed, 3) for s in states if 27_000 < s.Time < 40_000} == {3}
    last = states[-1]
    assert (last.Mode.name, last.CurrentCommand) == ("FlightDirector", 8)
    assert (last.Groundspeed, last.Course) == pytest.approx((5.0, 90.0), abs=0.01)


def test_what_uses_energy_and_has_none_stands() -> None:
    config, state = vehicle(EnergyRate=2.0)
    states = driven([config, state.copy(EnergyAvailable=40.0)],
                    (0.5, mission((900.0, 0.0))), seconds=40.0)  # fmt: skip
    assert states[-1].EnergyAvailable == states[-1].Groundspeed == 0
    assert 80 < track(states)[-1][0] < 170


def test_what_it_cannot_do_is_said_once_and_a_client_hears_of_all_of_it(tmp_path: Path) -> None:
    said = list[str]()
    events = [Event(0.0, body, "") for body in vehicle()]
    server = Server(lambda: World(events, 600), address("tcp://127.0.0.1:0", ("tcp",), free=True),
                    lambda kind, text: said.append(f"{kind}: {text}"))  # fmt: skip
    with contextlib.closing(server.port), contextlib.closing(Client(server.port.bound[1])) as one:
        for _ in range(5):
            server.turn(time.monotonic(), 0.1)
        for _ in range(2):
            one.send(order(hover(50, 0, 0, "Circular"), lmcp.new("GimbalStareAction",
                           PayloadID=3, Starepoint=lmcp.new("Location3D"))))  # fmt: skip
        director = lmcp.new("FlightDirectorAction", Heading=0.0, Altitude=300.0)
        one.send(order(director))
        for _ in range(10):
            server.turn(time.monotonic(), 0.1)
        assert [text for text in said if text.startswith("WARN")] == [
            "WARN: vehicle 1 does not fly: told a loiter of type Circular it stands at its middle",
            "WARN: vehicle 1 has nothing mounted for a GimbalStareAction: it is left out",
            "WARN: vehicle 1 does not fly: of a FlightDirectorAction it takes heading and speed alone",
        ]
        assert {"GroundVehicleConfiguration", "GroundVehicleState"} <= set(one.kinds())
        with contextlib.closing(Client(server.port.bound[1])) as late:
            for _ in range(5):
                server.turn(time.monotonic(), 0.1)
            assert late.kinds()[0] == "GroundVehicleConfiguration", "told to who comes late"


def test_a_camera_on_a_car_looks_where_it_is_told() -> None:
    gimbal = lmcp.new("GimbalConfiguration", PayloadID=3, MinAzimuth=-180.0, MaxAzimuth=180.0,
                      MinElevation=-90.0, MaxElevation=90.0, MaxAzimuthSlewRate=90.0,
                      MaxElevationSlewRate=90.0)  # fmt: skip
    look = lmcp.new("GimbalAngleAction", PayloadID=3, Azimuth=40.0, Elevation=10.0)
    states = driven(vehicle(PayloadConfigurationList=[gimbal]), (1.0, order(look)), seconds=5.0)
    assert states[-1].PayloadStateList[0].Azimuth == pytest.approx(40.0)


@pytest.mark.parametrize(
    ("bodies", "text"),
    [
        (vehicle(MaximumSpeed=0.0)[:1], "wrong speeds"),
        (vehicle(MinimumSpeed=math.nan)[:1], "wrong speeds"),
        (vehicle(NominalSpeed=math.inf)[:1], "wrong speeds"),
        (vehicle("Surface", MaxBankAngle=90.0)[:1], "wrong bank"),
        (vehicle()[1:], "a state of a vehicle without configuration"),
        ([vehicle()[0], vehicle("Surface")[1]], "a state of a vehicle without configuration"),
        ([vehicle()[0], vehicle()[1].copy(Heading=math.nan)], "a state that cannot be driven"),
        (
            [vehicle()[0], lmcp.new("AirVehicleConfiguration", ID=1)],
            "the same vehicle of two kinds",
        ),
        ([*vehicle(), order(hover(math.nan, 0, 0))], "a place that cannot be flown to"),
        ([*vehicle(), order().copy(VehicleID=2)], r"expected one of \[1\]"),
        (
            [*vehicle(), lmcp.new("FollowPathCommand", VehicleID=1, StartTime=9, StopTime=9)],
            "ends before it begins",
        ),
    ],
)
def test_what_cannot_be_driven_is_refused_by_name(bodies: list[Any], text: str) -> None:
    world = World((), 10)
    *before, wrong = bodies
    for body in before:
        world.receive(body, "here")
    with pytest.raises(BadInput, match=text):
        world.receive(wrong, "here")


def test_what_is_removed_tells_no_more_and_may_come_again() -> None:
    world = World((), 10)
    for body in (*vehicle(), lmcp.new("RemoveEntities", EntityList=[1])):
        world.receive(body)
    assert world.states() == []
    for body in vehicle("Surface"):
        world.receive(body)
    assert [type(s).__name__ for s in world.states()] == ["SurfaceVehicleState"]


def test_a_scenario_of_what_drives_is_played(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bodies = [*vehicle(), mission((50.0, 0.0)), order(hover(9, 9, 0, "Racetrack"))]
    inside = "".join(lmcp.xml.dumps(body) for body in bodies)
    path = tmp_path / "s.xml"
    path.write_text(f"<AMASE><ScenarioEventList>{inside}</ScenarioEventList></AMASE>")
    assert main(["sim", str(path), "--until", "20", "-o", str(tmp_path / "told.bin")]) == 0
    got = capsys.readouterr()
    assert "20 s of 0 aircraft and 1 that drive or sail" in got.out
    assert "WARN: vehicle 1 does not fly: told a loiter of type Racetrack" in got.err
    assert b"GroundVehicleState" in (tmp_path / "told.bin").read_bytes()
