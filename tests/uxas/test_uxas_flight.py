"""Tasks as they are flown outside: `cratous uxas` commands an aircraft of `cratous sim`."""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import PIPELINE, Rig, must_fly, place, request, vehicle
from uxas_flight import COMMANDS, Flight, across_m, fly, local, share_seen
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.world import Event

TASKS = "Task services"
BEGIN_S = 3.0


def line(number: int, *points: tuple[float, float]) -> Any:
    return lmcp.new(
        "LineSearchTask",
        TaskID=number,
        PointList=[lmcp.new("Location3D", Latitude=lat, Longitude=lon) for lat, lon in points],
    )


ZIGZAG = tuple((0.02 + 0.003 * k, 0.001 * (-1) ** k) for k in range(12))
NEXT = ((0.08, 0.01), (0.10, 0.01))


def aircraft(view_deg: float = 12.0) -> list[Any]:
    """Configuration and state of vehicle 1 at 20 m/s; its camera looks at the horizon at first."""
    configuration, state = vehicle(1)
    gimbal, camera = configuration.PayloadConfigurationList
    gimbal = gimbal.copy(
        MinAzimuth=-180.0, MaxAzimuth=180.0, MaxAzimuthSlewRate=100.0, MaxElevationSlewRate=100.0
    )
    camera = camera.copy(MinHorizontalFieldOfView=view_deg, MaxHorizontalFieldOfView=view_deg)
    level = configuration.NominalFlightProfile.copy(VerticalSpeed=0.0)
    ahead = lmcp.new("GimbalState", PayloadID=1, Azimuth=0.0, Elevation=0.0)
    return [
        configuration.copy(NominalFlightProfile=level, PayloadConfigurationList=[gimbal, camera]),
        state.copy(u=20.0, Airspeed=20.0, EnergyAvailable=100.0, PayloadStateList=[ahead]),
    ]


def flown(
    folder: Path, *tasks: Any, seconds: float, heard: tuple[str, ...] = COMMANDS, **attributes: str
) -> Flight:
    """Vehicle 1 does tasks in their order, by a whole UxAS."""
    kinds = (*PIPELINE, "WaypointPlanManagerService")
    attributes = {"WaypointPlanManagerService": 'VehicleID="1"', **attributes}
    text = "".join(f'<Service Type="{kind}" {attributes.get(kind, "")}/>\n' for kind in kinds)
    events = [Event(0.1 * k, body, "") for k, body in enumerate(aircraft())]
    order = ".(" + " ".join(f"p{task.TaskID}" for task in tasks) + ")"
    asked = request(*(task.TaskID for task in tasks), TaskRelationships=order)
    said = [(1.0, task) for task in tasks] + [(BEGIN_S, asked)]
    return fly(write_cfg(folder, text), events, seconds, said, heard)


@pytest.fixture(scope="module")
def zigzag(tmp_path_factory: pytest.TempPathFactory) -> Flight:
    """Two lines, one after the other; the first is narrower in its bends than the aircraft can turn."""
    folder = tmp_path_factory.mktemp("zigzag")
    return flown(folder, line(5, *ZIGZAG), line(6, *NEXT), seconds=700.0)


@pytest.mark.shows(TASKS, "EntityState", "TaskActive", "TaskComplete")
def test_tasks_are_active_and_complete_with_the_states_that_say_so(zigzag: Flight) -> None:
    """The last task too: the path ends with a waypoint that bears none."""
    lives = list[tuple[str, int, float]]()
    listed: tuple[int, ...] = ()
    for body in zigzag.states(1):
        now = tuple(body.AssociatedTasks)
        lives += [("TaskComplete", task, body.Time) for task in listed if task not in now]
        lives += [("TaskActive", task, body.Time) for task in now if task not in listed]
        listed = now
    told = [
        (kind, body.TaskID, at)
        for kind, body, at in (
            (type(e.body).__name__, e.body, getattr(e.body, field))
            for _, e in zigzag.told
            for field in ("TimeTaskActivated", "TimeTaskCompleted")
            if hasattr(e.body, field) and hasattr(e.body, "TaskID")
            if type(e.body).__name__ in ("TaskActive", "TaskComplete")
        )
    ]
    assert [(kind, task) for kind, task, _ in told] == [
        ("TaskActive", 5), ("TaskComplete", 5), ("TaskActive", 6), ("TaskComplete", 6),
    ]  # fmt: skip
    assert told == lives
    last = zigzag.command(1).WaypointList[-1]
    assert not last.AssociatedTasks
    before = zigzag.command(1).WaypointList[-2]
    assert (before.AssociatedTasks, before.NextWaypoint) == ([6], last.Number)
    assert (before.Latitude, before.Longitude) == (last.Latitude, last.Longitude)


@pytest.mark.shows(TASKS, "VehicleActionCommand")
def test_the_camera_looks_at_a_line_as_long_as_it_is_searched(zigzag: Flight) -> None:
    """With each state that lists the task, and once when it is complete; and all of the line is seen."""
    for number, points in ((5, ZIGZAG), (6, NEXT)):
        listed = [number in body.AssociatedTasks for body in zigzag.states(1)]
        looks = [
            action
            for command in zigzag.of("VehicleActionCommand")
            for action in command.VehicleActionList
            if number in action.AssociatedTaskList
        ]
        assert len(looks) == sum(listed) + 1
        assert {type(look).__name__ for look in looks} == {"GimbalStareAction"}
        path = local(line(1, *points).PointList, place(*points[0]))
        at = local([look.Starepoint for look in looks], place(*points[0]))
        assert max(across_m(at, path)) < 1.0
        assert math.dist(at[-1], path[-1]) < 30.0
        assert seen_of(zigzag, number, points) > 0.97, "planned is 0.99 or more"


def seen_of(flight: Flight, number: int, points: Any) -> float:
    """The share of a line that is seen from the first state that lists it to the last before the next task."""
    tasks = [body.AssociatedTasks for body in flight.states(1)]
    first = next(k for k, now in enumerate(tasks) if number in now)
    last = next((k for k, now in enumerate(tasks) if set(now) - {number} and k > first), None)
    return share_seen(line(1, *points).PointList, flight.states(1)[first:last])


def test_without_these_commands_less_of_the_line_is_seen(tmp_path: Path) -> None:
    alone = flown(tmp_path, line(5, *ZIGZAG), seconds=600.0, heard=COMMANDS[:1])
    assert seen_of(alone, 5, ZIGZAG) < 0.95


def shape(kind: str, **more: Any) -> Any:
    """A task around 0.03 N, 0 E."""
    middle = place(0.03).copy(Altitude=0.0)
    area = lmcp.new("Rectangle", CenterPoint=middle, Width=1_000.0, Height=800.0)
    where = {"AreaSearchTask": {"SearchArea": area}, "PointSearchTask": {"SearchLocation": middle}}
    return lmcp.new(kind, TaskID=5, **where[kind], **more)


def looks_of(rig: Rig) -> list[Any]:
    return [a for command in rig.got("VehicleActionCommand") for a in command.VehicleActionList]


def test_over_an_area_the_gimbal_is_held_at_the_planned_view(tmp_path: Path) -> None:
    """A view to the east: the azimuth turns against the heading; straight down it does not."""
    east = lmcp.new("Wedge", AzimuthCenterline=90.0, VerticalCenterline=-60.0)
    rig = Rig(tmp_path)
    rig.tell(*aircraft(50.0), shape("AreaSearchTask", ViewAngleList=[east]), request(5))
    state = aircraft(50.0)[1].copy(AssociatedTasks=[5], Heading=30.0)
    rig.tell(state, state.copy(Heading=-150.0, Time=1))
    assert [(a.type_name, a.PayloadID) for a in looks_of(rig)] == [
        ("CMASI/GimbalAngleAction", 1)
    ] * 2
    angles = [(a.Azimuth, a.Elevation) for a in looks_of(rig)]
    assert angles == [pytest.approx((60.0, -60.0)), pytest.approx((-120.0, -60.0))]
    rig.tell(shape("AreaSearchTask"), request(5))
    rig.tell(state)
    # a task that leaves it open: tilted along the lanes, which run to the east
    look = looks_of(rig)[-1]
    assert (look.Azimuth, look.Elevation) == pytest.approx((60.0, -45.0))


def test_an_area_is_searched_with_the_widest_view_that_the_camera_has_and_it_is_told(
    tmp_path: Path,
) -> None:
    """As the vehicle tells its state, its camera is zoomed in, which is no reason to search that way."""
    made = []
    narrow = [lmcp.new("CameraState", PayloadID=2, HorizontalFieldOfView=15.0)]
    for zoomed, least in (([], 10.0), (narrow, 10.0), (narrow, 0.0)):
        configuration, state = aircraft(50.0)
        gimbal, camera = configuration.PayloadConfigurationList
        both = [gimbal, camera.copy(MinHorizontalFieldOfView=least)]
        rig = Rig(tmp_path)
        state = state.copy(PayloadStateList=[*state.PayloadStateList, *zoomed])
        rig.tell(configuration.copy(PayloadConfigurationList=both), state)
        rig.tell(shape("AreaSearchTask"), request(5))
        (mission,) = rig.got("AutomationResponse")[-1].MissionCommandList
        actions = [a for point in mission.WaypointList for a in point.VehicleActionList]
        told = [a for a in actions if a.type_name == "CMASI/CameraAction"]
        assert [(a.PayloadID, a.HorizontalFieldOfView) for a in told] == [(2, pytest.approx(50.0))]
        made.append(len(mission.WaypointList))
    assert len(set(made)) == 1


def test_a_point_is_stared_at_and_what_needs_no_look_is_not(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*aircraft(50.0), shape("PointSearchTask"), must_fly(6), request(5))
    state = aircraft(50.0)[1].copy(AssociatedTasks=[5])
    rig.tell(state.copy(AssociatedTasks=[]), state, vehicle(2, 0.01)[1].copy(AssociatedTasks=[5]))
    (look,) = looks_of(rig)
    at = (look.Starepoint.Latitude, look.Starepoint.Longitude)
    assert at == pytest.approx((0.03, 0.0), abs=1e-6)
    rig.tell(request(6))
    rig.tell(state, state.copy(AssociatedTasks=[6]))
    assert len(rig.got("TaskActive")) == 2
    assert len(looks_of(rig)) == 1, "the plan that looked at the point is withdrawn"


def test_a_state_at_no_place_steers_nothing_and_is_logged(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*aircraft(50.0), shape("PointSearchTask"), request(5))
    state = aircraft(50.0)[1].copy(AssociatedTasks=[5])
    rig.tell(state.copy(Location=place(math.nan)), state.copy(Time=1))
    assert len(looks_of(rig)) == 1
    assert rig.said.has("not a place")


PLANNER = "RoutePlannerVisibilityService"


def waterway(shared: Path, folder: Path, separation_m: str) -> Flight:
    """OpenUxAS's example 02 on the simulator, by its own configuration but for this distance."""
    scenario = (shared / "vectors/amase/scenarios/02_waterway.xml").read_text()
    scenario = re.sub(r"<MissionCommand .*?</MissionCommand>", "", scenario, flags=re.DOTALL)
    files = shared / "examples/openuxas/waterway"
    text = (files / "cfg_run.xml").read_text()
    text = text.replace("../MessagesToSend/", f"{(files / 'inputs').resolve()}/")
    text = re.sub(r'<Message MessageFileName="AirVehicle.*?/>', "", text)
    text = re.sub(r"<Bridge .*?</Bridge>", "", text, flags=re.DOTALL)
    text = re.sub(r'<Service Type="AutomationDiagram.*?/>', "", text)
    text = re.sub(r'<Service Type="MessageLog.*?</Service>', "", text, flags=re.DOTALL)
    text = text.replace('Separation_m="50.0"', f'Separation_m="{separation_m}"')
    (folder / "cfg.xml").write_text(text)
    return fly(folder / "cfg.xml", of_text(scenario, "waterway").events, 785.0)


def off_path_m(flight: Flight, number: int) -> list[float]:
    """How far a vehicle was from its planned path, from its first waypoint until it made for the last [m]."""
    points = flight.command(number).WaypointList
    states = flight.states(number)
    first = next(k for k, body in enumerate(states) if body.CurrentWaypoint > points[0].Number)
    last = next(k for k, body in enumerate(states) if body.CurrentWaypoint == points[-1].Number)
    places = [body.Location for body in states[first:last]]
    return sorted(across_m(local(places, points[0]), local(points, points[0])))


@pytest.mark.shows(PLANNER, "MinimumWaypointSeparation_m")
def test_the_waterway_is_flown_nearer_to_its_path_and_seen_whole(
    shared: Path, tmp_path: Path
) -> None:
    """All waypoints, against those that are as far apart as the aircraft needs them; 149 m is its turn radius."""
    found = []
    for separation_m in ("0", "50.0"):
        flight = waterway(shared, tmp_path, separation_m)
        off = off_path_m(flight, 400)
        points = flight.command(400).WaypointList
        apart = [math.dist(a, b) for a, b in itertools.pairwise(local(points, points[0]))]
        assert [body.TaskID for body in flight.of("TaskComplete")] == [1000]
        found.append((sum(off) / len(off), off[int(0.95 * len(off))], sum(m < 149 for m in apart)))
    (task,) = flight.of("LineSearchTask")
    assert share_seen(task.PointList, flight.states(400)) == 1
    (mean_m, most_m, dense), (better_m, less_m, few) = found
    assert mean_m > 20, "as measured with AMASE, 28"
    assert better_m < 10, "the original's plan, in AMASE"
    assert most_m > 80
    assert less_m < 46
    assert dense > 200
    assert few < 5
