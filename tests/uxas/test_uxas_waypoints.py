"""Waypoint managers, each alone on a bus: segments, cycles, ends, and plans passed on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pipeline_messages import mission, response
from pipeline_tools import Rig
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.uxas.waypoints import Serving, WaypointPlanManagerService, path_of
from cratous.spec.errors import BadInput

MANAGER, SIMPLE = "WaypointPlanManagerService", "SimpleWaypointPlanManagerService"


def at(number: int, vehicle_id: int = 1, kind: str = "Air") -> Any:
    return lmcp.new(f"{kind}VehicleState", ID=vehicle_id, CurrentWaypoint=number)


def numbers(command: Any) -> list[int]:
    return [w.Number for w in command.WaypointList]


def manager(tmp_path: Path, attributes: str = "") -> Rig:
    return Rig(tmp_path, MANAGER, **{MANAGER: f'VehicleID="1" {attributes}'})


@pytest.mark.shows(
    MANAGER,
    "AutomationResponse",
    "MissionCommand",
    "AirVehicleState",
    "VehicleID",
    "NumberWaypointsToServe",
    "NumberWaypointsOverlap",
    "GroundVehicleState",
    "SurfaceVehicleState",
)
@pytest.mark.parametrize("kind", ["Air", "Ground", "Surface"])
def test_a_long_path_is_served_in_segments_that_overlap(tmp_path: Path, kind: str) -> None:
    rig = manager(tmp_path, 'NumberWaypointsToServe="5" NumberWaypointsOverlap="2"')
    rig.tell(response(mission(3, vehicle_id=2), mission(9)))
    (first,) = rig.got("MissionCommand")
    assert (numbers(first), first.FirstWaypoint, first.CommandID) == ([1, 2, 3, 4, 5], 1, 1)
    assert first.WaypointList[-1].NextWaypoint == 5
    rig.tell(at(2), at(3), at(4, 2, kind))
    assert len(rig.got("MissionCommand")) == 1
    rig.tell(at(4, 1, kind), at(4, 1, kind))
    second = rig.got("MissionCommand")[1]
    assert (numbers(second), second.FirstWaypoint) == ([4, 5, 6, 7, 8], 4)
    rig.tell(at(7), at(8), at(9))
    third = rig.got("MissionCommand")[2]
    assert (numbers(third), third.FirstWaypoint) == ([7, 8, 9], 7)
    assert len(rig.got("MissionCommand")) == 3
    rig.tell(mission(2))  # a command of another service's is a plan too
    assert numbers(rig.got("MissionCommand")[4]) == [1, 2]


def test_by_default_a_path_is_served_whole(tmp_path: Path) -> None:
    rig = manager(tmp_path)
    rig.tell(response(mission(40, first=3)))
    (command,) = rig.got("MissionCommand")
    assert (len(command.WaypointList), command.FirstWaypoint) == (38, 3)


def test_a_cycle_goes_on_for_ever(tmp_path: Path) -> None:
    rig = manager(tmp_path, 'NumberWaypointsToServe="3" NumberWaypointsOverlap="1"')
    rig.tell(response(mission(6, back_to=3)))
    flown = numbers(rig.got("MissionCommand")[0])
    for _ in range(6):
        rig.tell(at(flown[-1]))
        command = rig.got("MissionCommand")[-1]
        assert numbers(command)[0] == flown[-1] == command.FirstWaypoint
        flown += numbers(command)[1:]
    assert flown == [1, 2, 3, 4, 5, 6, 3, 4, 5, 6, 3, 4, 5, 6, 3]
    whole = manager(tmp_path)
    whole.tell(response(mission(6, back_to=3)))
    (command,) = whole.got("MissionCommand")
    assert command.WaypointList[-1].NextWaypoint == 3
    whole.tell(at(6), at(3))
    assert len(whole.got("MissionCommand")) == 1


@pytest.mark.shows(MANAGER, "IncrementWaypoint")
def test_the_next_waypoint_can_be_asked_for(tmp_path: Path) -> None:
    rig = manager(tmp_path, 'NumberWaypointsToServe="3" NumberWaypointsOverlap="1"')
    rig.tell(response(mission(5)), lmcp.new("IncrementWaypoint", VehicleID=7))
    assert len(rig.got("MissionCommand")) == 1
    for number in (2, 3, 4, 5, 5):
        rig.tell(lmcp.new("IncrementWaypoint", VehicleID=1))
        command = rig.got("MissionCommand")[-1]
        assert command.FirstWaypoint == number
        assert number in numbers(command)


@pytest.mark.shows(
    MANAGER,
    "AddLoiterToEndOfSegments",
    "AddLoiterToEndOfMission",
    "DefaultLoiterRadius_m",
    "SetLastWaypointSpeedTo0",
    "TurnType",
)
def test_ends_of_segments_and_of_the_mission(tmp_path: Path) -> None:
    rig = manager(
        tmp_path,
        'NumberWaypointsToServe="3" NumberWaypointsOverlap="1" AddLoiterToEndOfSegments="TRUE" '
        'AddLoiterToEndOfMission="TRUE" DefaultLoiterRadius_m="150" TurnType="FlyOver" '
        'SetLastWaypointSpeedTo0="TRUE"',
    )
    rig.tell(response(mission(5)))
    rig.tell(at(3))
    first, last = rig.got("MissionCommand")
    assert {w.TurnType.name for w in first.WaypointList} == {"FlyOver"}
    for command in (first, last):
        assert [len(w.VehicleActionList) for w in command.WaypointList] == [0, 0, 1]
        assert command.WaypointList[-1].VehicleActionList[0].Radius == 150.0
    assert (first.WaypointList[-1].Speed, last.WaypointList[-1].Speed) == (20.0, 0.0)


@pytest.mark.shows(MANAGER, "GimbalPayloadId")
@pytest.mark.parametrize("number", [-1, 0, 7])
def test_a_gimbal_looks_ahead_and_down_when_the_mission_has_ended(
    tmp_path: Path, number: int
) -> None:
    serve = f'GimbalPayloadId="{number}" NumberWaypointsToServe="3" NumberWaypointsOverlap="1"'
    rig = manager(tmp_path, serve)
    rig.tell(response(mission(5)), at(3))
    actions = [w.VehicleActionList for c in rig.got("MissionCommand") for w in c.WaypointList]
    assert not any(actions[:-1])
    found = [(type(a).__name__, a.PayloadID, a.Elevation) for a in actions[-1]]
    assert found == ([("GimbalAngleAction", 7, -60.0)] if number > 0 else [])


@pytest.mark.shows(MANAGER, "LoopBackToFirstTask")
def test_a_mission_may_loop_back_to_its_first_task(tmp_path: Path) -> None:
    rig = manager(tmp_path, 'LoopBackToFirstTask="TRUE"')
    rig.tell(response(mission(5)))
    assert rig.got("MissionCommand")[0].WaypointList[-1].NextWaypoint == 3


def test_segments_that_do_not_go_on_are_refused(tmp_path: Path) -> None:
    text = f'<Service Type="{MANAGER}" NumberWaypointsToServe="4" NumberWaypointsOverlap="4"/>'
    with pytest.raises(BadInput, match="less than NumberWaypointsToServe = 4"):
        process(write_cfg(tmp_path, text))


@given(st.integers(1, 30), st.integers(0, 30), st.integers(2, 12), st.data())
def test_segments_follow_the_path_without_a_gap(
    count: int, back: int, serve: int, data: Any
) -> None:
    """Whatever a vehicle tells: positions are served in order, none is left out."""
    overlap = data.draw(st.integers(1, serve - 1))
    serving = Serving(to_serve=serve, overlap=overlap)
    service = WaypointPlanManagerService("m", 1, serving)
    command = mission(count, back_to=back if back <= count else 0)
    path = path_of(command, serving)
    from cratous.services.bus import Envelope

    state, out = service._begin(service.start(), command)
    for _ in range(data.draw(st.integers(0, 12))):
        here = [path.waypoints[k].Number for k in path.indices(state.span)]
        number = data.draw(st.sampled_from([*here, 999]))
        before = state
        state, out = service.handle(
            state, Envelope(0, 0, "v", "afrl.cmasi.AirVehicleState", at(number)), 0
        )
        for made in out:
            assert made.FirstWaypoint == number
            assert number in numbers(made)
            assert len(set(numbers(made))) == len(numbers(made))
            assert before.span.first < state.span.first <= before.span.last < state.span.last


@pytest.mark.shows(SIMPLE, "AutomationResponse", "MissionCommand", "VehicleID")
def test_the_simple_manager_passes_a_vehicles_plan_on(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SIMPLE, **{SIMPLE: 'VehicleID="2"'})
    rig.tell(response(mission(3), mission(4, vehicle_id=2)))
    (command,) = rig.got("MissionCommand")
    assert (command.VehicleID, numbers(command), command.CommandID) == (2, [1, 2, 3, 4], 1)


@pytest.mark.shows(MANAGER, "VehicleActionCommand")
@pytest.mark.parametrize("kind", ["MissionCommand", "AutomationResponse"])
def test_a_mission_without_waypoints_is_over_and_the_vehicle_circles_where_it_is(
    tmp_path: Path, kind: str
) -> None:
    rig = manager(tmp_path, 'NumberWaypointsToServe="5" NumberWaypointsOverlap="2"')
    rig.tell(response(mission(9)))
    here = at(2).copy(Location=lmcp.new("Location3D", Latitude=1.0, Altitude=9.0), Airspeed=21.0)
    look = lmcp.new("GimbalAngleAction", PayloadID=3)
    over = lmcp.new("MissionCommand", VehicleID=1, VehicleActionList=[look])
    rig.tell(here, over if kind == "MissionCommand" else response(over))
    (stay,) = rig.got("VehicleActionCommand")
    first, circle = stay.VehicleActionList
    assert (stay.VehicleID, stay.CommandID, first) == (1, 2, look)
    assert (circle.Location, circle.Airspeed, circle.Radius) == (here.Location, 21.0, 200.0)
    assert (circle.LoiterType.name, circle.Duration) == ("Circular", -1)
    sent = len(rig.got("MissionCommand"))
    rig.tell(at(4), lmcp.new("IncrementWaypoint", VehicleID=1))
    assert len(rig.got("MissionCommand")) == sent, "no segment follows"
    rig.tell(response(mission(2)))
    assert rig.got("MissionCommand")[-1].CommandID == 3


def test_the_mission_of_a_vehicle_that_was_never_heard_is_over_without_a_command(
    tmp_path: Path,
) -> None:
    rig = manager(tmp_path, 'NumberWaypointsToServe="5" NumberWaypointsOverlap="2"')
    rig.tell(response(mission(9), lmcp.new("MissionCommand", VehicleID=2)))
    rig.tell(response(lmcp.new("MissionCommand", VehicleID=1)), at(4))
    assert len(rig.got("MissionCommand")) == 1
    assert not rig.got("VehicleActionCommand")
