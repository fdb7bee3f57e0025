"""The simulator: AMASE's recorded flights, its defects and their corrections, bad scenarios."""

from __future__ import annotations

import gzip
import itertools
import json
import math
from pathlib import Path
from typing import Any

import pytest
from simulator_tools import (
    CAMERA,
    DIRECTOR,
    DOWN,
    GO_TO,
    LOITER,
    STARE,
    mission,
    ordered,
    scenario,
    waypoint,
)

from cratous.bridge import lmcp
from cratous.services.conform import trajectory
from cratous.services.simulator.guidance import Leg, Waypoint, reached
from cratous.services.simulator.scenario import of_text, read
from cratous.services.simulator.world import World
from cratous.spec.errors import BadInput


def fly(text: str, until_s: float, compatible: bool = False) -> list[Any]:
    """The states that vehicle 1 tells."""
    plan = of_text(text, "test")
    world = World(plan.events, plan.duration_s, compatible=compatible)
    told = []
    while world.time_s < until_s:
        told += [b for b in world.tick() if type(b).__name__ == "AirVehicleState" and b.Time > 0]
    return told


def away_m(state: Any, lat: float, lon: float = -120.0) -> float:
    north = (state.Location.Latitude - lat) * 111_200
    return math.hypot(
        north, (state.Location.Longitude - lon) * 111_200 * math.cos(math.radians(lat))
    )


def test_recorded_flights_of_amase_are_flown_again(shared: Path) -> None:
    with gzip.open(shared / "vectors/amase/traj-open.jsonl.gz", "rt") as lines:
        for number, line in enumerate(lines):
            case = json.loads(line)
            result = trajectory.judge(case)
            assert result.status == "passed", result
            if number > 1:
                continue
            case["rows"][-1][case["columns"].index("Longitude")] += 0.0003
            assert trajectory.judge(case).status == "failed", "20 m off are seen"
            case["rows"][-1][case["columns"].index("CurrentWaypoint")] += 1
            assert "CurrentWaypoint differs in 1 states" in trajectory.judge(case).text
            case["rows"][9][case["columns"].index("Latitude")] = float("nan")
            assert trajectory.judge(case).status == "failed"
            assert "no number" in str(trajectory.judge(case))


def test_the_same_scenario_tells_the_same_bytes() -> None:
    text = scenario(mission(waypoint(1, 2, 45.01), waypoint(2, 2, 45.03)))
    one, two = ([lmcp.binary.pack(s) for s in fly(text, 120)] for _ in range(2))
    assert one == two
    assert len(one) > 200


@pytest.mark.parametrize(("compatible", "low", "high"), [(False, 599, 601), (True, 1000, 3000)])
def test_a_climb_rate_ends_at_the_altitude_but_in_amase(
    compatible: bool, low: float, high: float
) -> None:
    last = fly(scenario(ordered(5, DIRECTOR)), 300, compatible)[-1]
    assert low < last.Location.Altitude < high
    assert last.Mode.name == "FlightDirector"
    assert last.CurrentCommand == 8
    assert abs(last.Heading - 90) < 1


def test_go_to_a_waypoint_flies_there_but_in_amase() -> None:
    text = scenario(
        mission(waypoint(1, 2, 45.02), waypoint(2, 3, 45.1), waypoint(3, 3, 45.2)),
        ordered(30, GO_TO.format(3)), ordered(60, GO_TO.format(1)),
    )  # fmt: skip
    ours, theirs = fly(text, 40)[-1], fly(text, 40, True)[-1]
    assert (ours.Mode.name, ours.CurrentWaypoint, ours.CurrentCommand) == ("Waypoint", 3, 7)
    assert theirs.Mode.name == "Loiter"
    assert fly(text, 61)[-1].CurrentWaypoint == 1
    unknown = scenario(mission(waypoint(1, 1, 45.02)), ordered(9, GO_TO.format(5)))
    assert fly(unknown, 20)[-1].CurrentWaypoint == 1, "there is no waypoint 5: on as before"


def test_a_timed_loiter_takes_milliseconds_and_the_route_goes_on() -> None:
    text = scenario(
        mission(
            waypoint(1, 2, 45.02, LOITER.format("Circular", 60_000)),
            waypoint(2, 2, 45.05),
        )
    )
    told = fly(text, 400)
    loitering = [s.Time for s in told if s.Mode.name == "Loiter"]
    assert 58_000 < loitering[-1] - loitering[0] < 62_000
    assert told[-1].CurrentWaypoint == 2
    assert told[-1].Mode.name == "Waypoint"
    assert min(away_m(s, 45.05) for s in told) < 200


@pytest.mark.parametrize("kind", ["Circular", "Racetrack", "FigureEight", "VehicleDefault"])
def test_loiters_stay_about_their_place(kind: str) -> None:
    told = fly(scenario(ordered(1, LOITER.format(kind, 0))), 590)
    later = [away_m(s, 45.02) for s in told if s.Time > 200_000]
    assert max(later) < (400 if kind in ("Circular", "VehicleDefault") else 1100)
    assert abs(told[-1].Location.Altitude - 400) < 1
    if kind == "Circular":
        assert min(later) > 250


def test_a_hover_stands_still_where_the_airframe_can() -> None:
    last = fly(scenario(ordered(1, LOITER.format("Hover", 0)), least_m_s=0), 400)[-1]
    assert away_m(last, 45.02) < 5
    assert last.Groundspeed < 1
    circling = fly(scenario(ordered(1, LOITER.format("Hover", 0))), 400)[-1]
    assert circling.Groundspeed > 17
    assert away_m(circling, 45.02) < 400


def test_wind_moves_the_aircraft_and_is_told() -> None:
    wind = """<WeatherReport Series="CMASI"><WindSpeed>10</WindSpeed>
<WindDirection>270</WindDirection></WeatherReport>"""
    one, two = fly(scenario(wind, ordered(1, DIRECTOR)), 60)[-2:]
    flown = away_m(two, one.Location.Latitude, one.Location.Longitude)
    assert flown / ((two.Time - one.Time) / 1000) == pytest.approx(two.Groundspeed, rel=0.01)
    assert two.Groundspeed > 29
    assert (two.WindSpeed, two.WindDirection) == (10, 270)
    assert two.Course == pytest.approx(90, abs=1)


def test_without_energy_an_aircraft_stands() -> None:
    told = fly(scenario(energy=0.1), 30)
    assert told[-1].EnergyAvailable == 0
    assert told[-1].Airspeed == 0
    assert told[-1].Location.Latitude == told[-5].Location.Latitude > 45


def test_a_stare_sees_its_place_in_the_middle_of_the_picture() -> None:
    for state in fly(scenario(ordered(1, STARE + DIRECTOR), payloads=CAMERA), 60)[20:]:
        (gimbal, camera) = state.PayloadStateList
        assert gimbal.PointingMode.name == "LatLonSlaved"
        assert (
            math.hypot(
                (camera.Centerpoint.Latitude - 45.01) * 111_200,
                (camera.Centerpoint.Longitude + 119.995) * 78_600,
            )
            < 20
        )


def test_a_camera_that_looks_down_sees_the_ground_below() -> None:
    state = fly(scenario(ordered(1, DOWN), payloads=CAMERA), 30)[-1]
    camera = state.PayloadStateList[1]
    wide = 2 * 400 * math.tan(math.radians(camera.HorizontalFieldOfView / 2))
    one, two = camera.Footprint[:2]
    assert (two.Longitude - one.Longitude) * 78_600 == pytest.approx(wide, rel=0.02)
    assert away_m(state, camera.Centerpoint.Latitude, camera.Centerpoint.Longitude) < 5


def test_what_counts_as_reached() -> None:
    to = Waypoint(1, 2, 0.0, 0.0, 0.0, 20.0, True, (), ())
    over = Leg(to, None, to)
    assert reached(over, 50, math.pi, 0.0, 100)
    assert not reached(over, 50, 0.0, 0.0, 100)
    assert not reached(over, 150, math.pi, 0.0, 100)
    # a right turn of 90 degrees begins one radius ahead
    short = Leg(to._replace(fly_over=False), None, to, back_rad=-math.pi / 2, then_m=1e4)
    assert reached(short, 99, 0.0, 0.0, 100)
    assert not reached(short, 101, 0.0, 0.0, 100)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<UxAS/>", "not an AMASE scenario"),
        ("<AMASE><ScenarioEventList>", "line|expected|wrong|ends"),
        (scenario(ordered(-1, DIRECTOR)), "not a time"),
        (scenario().replace('<ID>1</ID><u>', '<ID>2</ID><u>'), "without configuration"),
        (scenario(ordered(1, LOITER.format("Circular", 0).replace(">300<", ">0<"))), "Radius"),
        (scenario().replace("<Latitude>45<", "<Latitude>95<"), "cannot be flown"),
        (scenario(least_m_s=50), "MinimumSpeed"),
        (scenario(ordered(1, DIRECTOR).replace("<VehicleID>1", "<VehicleID>3")), "not there"),
    ],
)  # fmt: skip
def test_a_bad_scenario_is_named_by_its_place(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.xml"
    path.write_text(text)
    with pytest.raises(BadInput, match=said) as error:
        play(path)
    assert "bad.xml" in str(error.value)


def play(path: Path) -> None:
    plan = read(path)
    world = World(plan.events, plan.duration_s)
    while world.time_s < 5:
        world.tick()


def test_links_are_read_and_circles_of_them_refused(tmp_path: Path) -> None:
    link = '<AMASE><ScenarioEventList><Link Source="{}"/></ScenarioEventList></AMASE>'
    (tmp_path / "a.xml").write_text(link.format("b.xml"))
    (tmp_path / "b.xml").write_text(scenario())
    assert len(read(tmp_path / "a.xml").events) == 2
    (tmp_path / "b.xml").write_text(link.format("a.xml"))
    with pytest.raises(BadInput, match=r"b\.xml.*circle"):
        read(tmp_path / "a.xml")


def test_what_cannot_be_flown_changes_nothing() -> None:
    """Nulls and numbers that are none, as a client may send them; of a response all or nothing."""
    plan = of_text(scenario(mission(waypoint(1, 1, 45.02, LOITER.format("Circular", 0)))), "x")
    configuration, state, command = (event.body for event in plan.events)
    world = World(plan.events, 600)
    while world.time_s < 2:
        world.tick()
    before = world.aircraft
    (w,) = command.WaypointList
    (loiter,) = w.VehicleActionList
    angle = lmcp.new("GimbalAngleAction", Azimuth=math.nan)
    good = command.copy(CommandID=77)
    bad = [
        state.copy(Heading=math.inf),
        configuration.copy(ID=2, AlternateFlightProfiles=[None]),
        command.copy(WaypointList=[None]),
        command.copy(WaypointList=[w.copy(VehicleActionList=[None])]),
        command.copy(WaypointList=[w.copy(Speed=math.inf)]),
        *(
            lmcp.new("VehicleActionCommand", VehicleID=1, VehicleActionList=[one])
            for one in (None, angle, loiter.copy(Radius=-1.0))
        ),
        lmcp.new("AutomationResponse", MissionCommandList=[good, good.copy(VehicleID=5)]),
        lmcp.new("WeatherReport", WindSpeed=math.nan),
    ]
    for body in bad:
        with pytest.raises(BadInput):
            world.receive(body, "a client")
    assert world.aircraft == before
    assert world.aircraft[1].guidance.route_id == 7
    world.receive(lmcp.new("AutomationResponse", MissionCommandList=[good]), "a client")
    assert world.aircraft[1].guidance.route_id == 77


def test_a_recorded_session_of_amase_is_told_again(shared: Path) -> None:
    """Places, gimbals and footprints of two aircraft with cameras that fly a route, 26 s."""
    plan = read(shared / "vectors/amase/scenarios/02_waterway.xml")
    world = World(plan.events, 30, compatible=True)
    told = {}
    while not world.over:
        for body in world.tick():
            if type(body).__name__ == "AirVehicleState":
                told[body.ID, body.Time] = body
    compared = 0
    with gzip.open(shared / "vectors/amase/session-waterway-rate1.jsonl.gz", "rt") as lines:
        for message in (json.loads(line)["msg"] for line in lines):
            if message["$type"] != "CMASI/AirVehicleState" or not message["Time"]:
                continue
            state = told[message["ID"], message["Time"]]
            compared += 1
            pairs = [(state.Location, message["Location"], 0.01)]
            for ours, theirs in zip(
                state.PayloadStateList, message["PayloadStateList"], strict=True
            ):
                assert ours.Elevation == pytest.approx(theirs["Elevation"], abs=1e-4)
                if theirs["$type"] == "CMASI/CameraState":
                    pairs += zip(ours.Footprint, theirs["Footprint"], [0.01] * 4, strict=True)
            for place, wanted, near_m in pairs:
                assert away_m_to(place, wanted) < near_m
    assert compared > 90


def away_m_to(place: Any, wanted: dict[str, float]) -> float:
    return math.hypot(
        (place.Latitude - wanted["Latitude"]) * 111_200,
        (place.Longitude - wanted["Longitude"]) * 78_200,
    )


def test_states_come_each_half_second_and_as_late_as_amases_in_compatibility() -> None:
    """A heartbeat of ICAROUS comes with each, so at 0.54 s every decision over several of them came late."""

    def times(compatible: bool, until_s: int) -> list[int]:
        world = World((), until_s, compatible=compatible)
        return [one.ScenarioTime for _ in range(100 * until_s) for one in world.tick()]

    assert times(False, 600) == list(range(500, 600_001, 500))
    late = times(True, 60)
    assert 540 in {after - before for before, after in itertools.pairwise(late)}
