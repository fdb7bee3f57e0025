"""Rendezvous by direct ways: from where the vehicles are, at one time, without laps where their speeds suffice."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from following_tools import aircraft
from pipeline_tools import Rig, place, request
from rendezvous_tools import PLACES, flown, meeting, passed_s, told
from uxas_flight import local

from cratous.bridge import lmcp

TASKS = "Task services"


@pytest.mark.shows(TASKS, "VehicleActionCommand", "TaskComplete")
def test_three_vehicles_pass_their_states_at_one_time(tmp_path: Path) -> None:
    at = {1: 0.0, 2: 0.004, 3: 0.012}
    flight = flown(tmp_path, meeting(1, 2, 3), at=at, seconds=240.0, east=-0.015)
    (complete,) = flight.of("TaskComplete")
    assert complete.EntitiesInvolved == [1, 2, 3]
    found = [passed_s(flight, v, PLACES[v - 1]) for v in (1, 2, 3)]
    times = [time for time, _ in found]
    assert max(times) - min(times) <= 2.0
    assert max(away for _, away in found) < 40
    # who has the longest way flies it at a speed near to its fastest, and nobody waits in laps
    assert max(times) < 215
    assert not any(s.Mode.name == "Loiter" for v in at for s in flight.states(v))
    # and nobody flew at another speed than its own limits
    speeds = [s.Airspeed for v in at for s in flight.states(v) if s.Time > 60_000]
    assert 14.9 < min(speeds) <= max(speeds) < 30.1


def _on_their_ways(folder: Path) -> tuple[Rig, list[lmcp.LmcpObject], list[list[int]]]:
    """Two vehicles just begun on direct ways: their states so far, and the waypoints of the task."""
    rig = told(folder, meeting(1, 2))
    states, numbers, planned = [], [], []
    for vehicle in (1, 2):
        command = next(
            c
            for c in rig.got("AutomationResponse")[-1].MissionCommandList
            if c.VehicleID == vehicle
        )
        mine = [w for w in command.WaypointList if w.AssociatedTasks]
        numbers.append([w.Number for w in mine])
        assert len(mine) > 3
        ways = zip(local(mine[1:-1], mine[0]), local(mine[:-2], mine[0]), strict=True)
        length = sum(math.dist(p, q) for p, q in ways)
        planned.append((mine[1].Speed, length / mine[1].Speed))
        assert [w.Speed for w in mine[2:]] == [*[mine[1].Speed] * (len(mine) - 3), 20.0]
        states.append(
            aircraft(vehicle, 0.001 * vehicle)[1].copy(
                AssociatedTasks=[5], Mode="Waypoint", CurrentWaypoint=mine[0].Number, Time=1000
            )
        )
    speeds, times = zip(*planned, strict=True)
    assert max(times) - min(times) < 1.0, "as planned they come at one time"
    assert 20.0 < min(speeds) < max(speeds) == pytest.approx(28.5, abs=0.01), (
        "as soon as the last one can"
    )
    return rig, states, numbers


def test_who_is_heard_alone_waits_only_when_it_comes_to_its_gate(tmp_path: Path) -> None:
    rig, (one, two), ((_, after, *_), _) = _on_their_ways(tmp_path)
    rig.tell(one)
    assert not rig.got("VehicleActionCommand"), "there is time for the other one to be heard"
    near = one.copy(Location=place(0.0025), Time=7000)  # the gate is 200 m ahead of where it began
    rig.tell(near)
    (command,) = rig.got("VehicleActionCommand")
    assert type(command.VehicleActionList[0]).__name__ == "LoiterAction"
    here = near.copy(
        Location=place(0.001 + 200 / 111_195), Mode="Loiter", CurrentCommand=command.CommandID
    )
    far = two.copy(CurrentWaypoint=two.CurrentWaypoint + 1)
    for time_ms in (8_000, 9_000, 10_000):
        rig.tell(here.copy(Time=time_ms), far.copy(Time=time_ms))
    goes = [
        action.WaypointNumber
        for command in rig.got("VehicleActionCommand")
        for action in command.VehicleActionList
        if type(action).__name__ == "GoToWaypointAction"
    ]
    assert set(goes) == {after}, "it goes on along its way"


def test_a_direct_way_through_a_zone_is_not_offered(tmp_path: Path) -> None:
    lengths = []
    for folder, zones in (("free", []), ("zone", [3])):
        (tmp_path / folder).mkdir()
        rig = Rig(tmp_path / folder)
        for vehicle in (1, 2):
            configuration, state = aircraft(vehicle, 0.001 * vehicle)
            rig.tell(configuration.copy(MinimumSpeed=15.0), state)
        area = lmcp.new("Circle", CenterPoint=place(0.015), Radius=300.0)
        zone = lmcp.new("KeepOutZone", ZoneID=3, Boundary=area, MaxAltitude=1000.0)
        rig.tell(zone, lmcp.new("OperatingRegion", ID=4, KeepOutAreas=zones), meeting(1, 2))
        rig.tell(request(5, vehicles=(1, 2), OperatingRegion=4))
        commands = rig.got("AutomationResponse")[-1].MissionCommandList
        lengths.append([sum(bool(w.AssociatedTasks) for w in c.WaypointList) for c in commands])
    free, around = lengths
    assert min(free) > 3
    assert around == [3, 3]
