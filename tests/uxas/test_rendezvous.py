"""Rendezvous, flown in the simulator: `cratous uxas` commands the aircraft of `cratous sim`.

When each passed its state is judged here from the states alone.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import aircraft
from pipeline_tools import Rig, must_fly, place, request
from rendezvous_tools import PLACES, flown, meeting, passed_s, told, under_way

from cratous.bridge import lmcp

pytestmark = pytest.mark.usefixtures("straight_run_ins")


def test_the_wind_moves_the_common_time_and_not_the_vehicles_apart(tmp_path: Path) -> None:
    """A wind from behind: the slowest that they fly over ground is 23 m/s, and a lap takes longer."""
    at, wind = {1: 0.0, 2: -0.01, 3: 0.01}, (8.0, 180.0)
    flight = flown(tmp_path, meeting(1, 2, 3), at=at, seconds=270.0, wind=wind)
    assert [v for v in at if any(s.Mode.name == "Loiter" for s in flight.states(v))]
    assert flight.of("TaskComplete")[0].EntitiesInvolved == [1, 2, 3]
    found = [passed_s(flight, v, PLACES[v - 1]) for v in (1, 2, 3)]
    assert max(time for time, _ in found) - min(time for time, _ in found) <= 2.0
    assert max(away for _, away in found) < 40


def test_two_of_three_come_to_one_place_and_go_on_in_their_plans(tmp_path: Path) -> None:
    task = meeting(0, needed=2)
    flight = flown(
        tmp_path, task, must_fly(6, 0.07, 0.0), at={1: 0.0, 2: 0.01, 3: -0.03}, seconds=480.0
    )
    done = [(body.TaskID, body.EntitiesInvolved) for body in flight.of("TaskComplete")]
    assert done[0] == (5, [1, 2]), "the nearest two"
    assert [number for number, _ in done] == [5, 6]
    one, two = (passed_s(flight, v, PLACES[0]) for v in (1, 2))
    assert abs(one[0] - two[0]) <= 2.0
    assert max(one[1], two[1]) < 40


STATE = lmcp.new("PlanningState", EntityID=0, PlanningPosition=place(0.04))


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ({"NumberOfParticipants": 0}, "NumberOfParticipants: out of range; expected 1 to 8; got 0"),
        ({"NumberOfParticipants": 9}, "expected 1 to 8; got 9"),
        ({"RendezvousStates": []}, "number of RendezvousStates"),
        ({"RendezvousStates": [STATE] * 10_000}, "expected 1 to 64; got 10000"),
        (
            {"RendezvousStates": [STATE.copy(PlanningHeading=math.nan)]},
            "PlanningHeading: wrong value",
        ),
        (
            {"RendezvousStates": [STATE.copy(PlanningPosition=place(99.0))]},
            "RendezvousStates[0]: not a place",
        ),
        (
            {"Parameters": [lmcp.new("KeyValuePair", Key="Tolerance_ms", Value="-1")]},
            "Tolerance_ms: out of range; expected 1 to 600000; got -1",
        ),
        (
            {"Parameters": [lmcp.new("KeyValuePair", Key="Wait_ms", Value="9" * 5_000)]},
            "Wait_ms: out of range; expected 1 to 8.64e+07; got 9999",
        ),
        ({"RendezvousStates": [STATE.copy(EntityID=77)] * 2}, "entity 77, which is none of its"),
        ({"NumberOfParticipants": 3}, "no 3 vehicles have a state each"),
    ],
)
def test_what_cannot_be_met_is_refused_with_what_and_where(
    tmp_path: Path, more: dict[str, Any], reason: str
) -> None:
    rig = told(tmp_path, meeting(1, 2, **more))
    said = rig.reasons() + rig.reasons("Warning")
    assert any(reason in text for text in said), said
    assert not rig.got("MissionCommand")
    # another request of the same process is answered
    rig.tell(must_fly(6), request(6, vehicles=(1, 2)))
    rig.wait(6_000)
    assert rig.got("AutomationResponse")[-1].MissionCommandList


def test_an_altitude_that_is_not_flown_is_said(tmp_path: Path) -> None:
    low = STATE.copy(PlanningPosition=place(0.04).copy(Altitude=50.0))
    rig = told(tmp_path, meeting(RendezvousStates=[low], needed=1))
    text = (
        "vehicle 1 passes RendezvousStates[0] of task 5 at its own altitude, 300 m MSL, not at 50 m"
    )
    assert text in rig.reasons("Warning")
    assert rig.got("AutomationResponse")[-1].MissionCommandList


def test_too_many_ways_to_meet_are_refused_at_once(tmp_path: Path) -> None:
    rig = told(tmp_path, meeting(0, needed=8), vehicles=16)
    assert any("too many ways" in text for text in rig.reasons()), rig.reasons()


def test_who_cannot_change_its_speed_or_wait_is_not_offered(tmp_path: Path) -> None:
    for folder, more, text in (
        ("speed", {"MinimumSpeed": 20.0, "MaximumSpeed": 20.0}, "no common time can be kept"),
        ("zone", {}, "zone 3"),
    ):
        (tmp_path / folder).mkdir()
        area = lmcp.new("Circle", CenterPoint=place(0.04), Radius=900.0)
        zone = lmcp.new("KeepOutZone", ZoneID=3, Boundary=area, MaxAltitude=1000.0)
        region = lmcp.new("OperatingRegion", ID=4, KeepOutAreas=[3] if folder == "zone" else [])
        rig = Rig(tmp_path / folder)
        for vehicle in (1, 2):
            configuration, state = aircraft(vehicle, 0.001 * vehicle)
            rig.tell(configuration.copy(**{"MinimumSpeed": 15.0, **more}), state)
        rig.tell(zone, region, meeting(1, 2))
        rig.tell(request(5, vehicles=(1, 2), OperatingRegion=4))
        said = rig.reasons("Warning")
        assert any(text in one for one in said), said


def test_each_is_told_the_speed_at_which_it_arrives(tmp_path: Path) -> None:
    rig, states = under_way(tmp_path)
    # the second one is 100 m behind by now: the first is told to fly slower
    behind = states[1].Location.copy(Latitude=states[1].Location.Latitude - 0.0009)
    rig.tell(states[1].copy(Location=behind, Time=2000), states[0].copy(Time=2000))
    one, two = (
        [
            action.Speed
            for command in rig.got("VehicleActionCommand")
            if command.VehicleID == v
            for action in command.VehicleActionList
        ][-1]
        for v in (1, 2)
    )
    assert 15.0 <= one < two <= 30.0


def test_where_no_common_time_is_left_it_is_said_and_nobody_waits(tmp_path: Path) -> None:
    rig, states = under_way(tmp_path)
    near = states[0].copy(Location=place(PLACES[0][0] - 0.0005), Time=2000)
    rig.tell(near, states[1].copy(Time=2000), near.copy(Time=30_000), states[1].copy(Time=30_000))
    said = rig.reasons("Warning")
    assert any("there is no common time any more" in text for text in said), said
    assert not rig.got("TaskComplete")


@pytest.mark.parametrize(
    ("before", "told", "reason"),
    [
        (33_500, 34_500, ""),
        (28_000, 34_500, "vehicle 2 arrived -6.2 to 0.3 s after the common time"),
        (28_000, 29_000, "vehicle 2 arrived -6.2 to -5.2 s after the common time"),
    ],
)
def test_complete_is_only_what_was_seen_to_be_in_time(
    tmp_path: Path, before: int, told: int, reason: str
) -> None:
    """The second one passes between two of its states; its last one comes when the first one has passed in time."""
    rig, states = under_way(tmp_path)

    def at(k: int, time_ms: int, north: float) -> Any:
        there = place(PLACES[k][0] + north, PLACES[k][1])
        return states[k].copy(Time=time_ms, Location=there)

    for time_ms in (1_000, 15_000, 28_000):
        north = -0.006 * (34_400 - time_ms) / 33_400
        rig.tell(*(at(k, time_ms, north) for k in (0, 1)))
    rig.tell(at(1, before, -0.0002), at(0, 33_500, -0.0002), at(0, 34_500, 0.0001))
    rig.tell(at(1, told, 0.0001))
    said = rig.reasons("Warning")
    assert bool(rig.got("TaskComplete")) == (not reason)
    assert not reason or any(reason in text for text in said), said


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"AssociatedTasks": []}, "vehicle 2 flies it no more"),
        ({"Location": place(PLACES[1][0] + 0.001, PLACES[1][1] + 0.01)}, "m aside"),
        ({"ID": 9, "Time": 40_000}, "vehicle 2 was not heard for 30 s"),
        ({"Location": place(math.nan)}, "vehicle 2 is not steered"),
        ({"WindSpeed": math.nan}, "a wind that is no number"),
    ],
)
def test_who_falls_out_is_said_and_another_request_is_done(
    tmp_path: Path, change: dict[str, Any], reason: str
) -> None:
    rig, states = under_way(tmp_path)
    rig.tell(states[1].copy(**{"Time": 2000, **change}), states[0].copy(Time=2000))
    if "ID" in change:
        rig.tell(states[0].copy(Time=40_000))
    said = rig.reasons("Warning")
    assert any(reason in text for text in said), said
    assert not rig.got("TaskComplete")
    rig.tell(aircraft(1, 0.0)[1], aircraft(2, 0.001)[1], request(5, vehicles=(1, 2)))
    assert rig.got("AutomationResponse")[-1].MissionCommandList
