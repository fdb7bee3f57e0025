"""Cordons driven: `cratous uxas` commands the vehicles of `cratous sim`, along the streets of the example's map.

What was driven is judged here from the states alone.
"""

from __future__ import annotations

import math
import re
import shutil
from pathlib import Path
from typing import Any

from pipeline_tools import PIPELINE, request
from road_tools import EXAMPLE, MIDDLE, ROADS, at, car, map_text
from uxas_flight import Flight, across_m, fly, local
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.simulator import scenario
from cratous.services.simulator.world import Event

HEARD = ("afrl.cmasi.AutomationResponse", "afrl.cmasi.VehicleActionCommand")
NEXT, IN_TURN = 0.01, ".(p100 p101)"
"""How far north of the first cordon the second is [deg], which comes after it."""


def cordon(number: int = 100, north: float = 0.0, radius_m: float = 100.0, **more: Any) -> Any:
    return lmcp.new("CordonTask", TaskID=number, StandoffDistance=radius_m,
                    CordonLocation=at(MIDDLE[0] + north, MIDDLE[1]), **more)  # fmt: skip


STREET = {1: (MIDDLE[0] - 0.01, MIDDLE[1]), 2: (MIDDLE[0] + 0.02, MIDDLE[1])}


def driven(
    folder: Path, seconds: float, *tasks: Any, said: Any = (), count: int = 2, **more: Any
) -> Flight:
    """Cars in a row, north of the middle, told to block roads: two on one street alone, four in those of the example."""
    roads = EXAMPLE / "roads.osm"
    if count == 2:
        roads = folder / "street.osm"
        roads.write_text(map_text(STREET, [1, 2]))
    kinds = [
        f'<Service Type="{ROADS}" OsmFile="{roads}"/>',
        *(f'<Service Type="{k}"/>' for k in PIPELINE),
    ]
    numbers = range(1, count + 1)
    bodies = [b for n in numbers for b in car(n, MIDDLE[0] + 0.002 + 0.0004 * n, MIDDLE[1])]
    events = [Event(0.0, body, "") for body in bodies]
    later = [(1.0, one) for one in tasks]
    asked = request(*(one.TaskID for one in tasks), vehicles=tuple(numbers), **more)
    later += [(2.0, asked), *said]
    return fly(write_cfg(folder, "\n".join(kinds)), events, seconds, later, HEARD)


def states(flight: Flight, vehicle: int) -> list[Any]:
    return [s for s in flight.of("GroundVehicleState") if vehicle == s.ID]


def away_m(flight: Flight, vehicle: int, place: Any) -> list[tuple[int, float]]:
    """When [ms], and how far a vehicle was from a place."""
    told = states(flight, vehicle)
    return [(s.Time, math.hypot(*p)) for s, p in zip(told, local([s.Location for s in told], place), strict=True)]  # fmt: skip


def places(flight: Flight, task: int) -> dict[int, Any]:
    """By vehicle the place where it blocks a road for a task."""
    commands = flight.of("AutomationResponse")[-1].MissionCommandList
    own = {c.VehicleID: [w for w in c.WaypointList if task in w.AssociatedTasks] for c in commands}
    return {vehicle: ways[-1] for vehicle, ways in own.items() if ways}


def complete(flight: Flight) -> dict[int, int]:
    """When tasks were complete [ms]."""
    return {body.TaskID: body.TimeTaskCompleted for body in flight.of("TaskComplete")}


def test_the_example_is_driven_to_its_end(tmp_path: Path) -> None:
    folder = shutil.copytree(EXAMPLE, tmp_path / "cordon")
    cfg = folder / "cfg_driven.xml"
    text = re.sub(r"<Bridge.*?</Bridge>", "", cfg.read_text(), flags=re.DOTALL)
    cfg.write_text(re.sub(r'<Service Type="(AutomationDiagram|Test_)\w+"/>', "", text))
    plan = scenario.read(folder / "scenario.xml")
    flight = fly(cfg, plan.events, 750.0, (), HEARD)
    blocked, end_ms = places(flight, 100), complete(flight)[100]
    assert sorted(blocked) == [13, 14, 15, 16]
    planned_ms = 728_386
    assert planned_ms < end_ms - 2000 < 1.03 * planned_ms, "corners and braking are not planned"
    arrived = []
    for vehicle, place in blocked.items():
        away, told = away_m(flight, vehicle, place), states(flight, vehicle)
        arrived.append(max(s.Time for s in told if s.Groundspeed > 0.5 and s.Time <= end_ms))
        assert max(far for time, far in away if time > arrived[-1]) < 1, "it stays there"
        path = local(
            [states(flight, vehicle)[0].Location, *flight.command(vehicle).WaypointList], place
        )
        track = local([s.Location for s in states(flight, vehicle)], place)
        assert max(across_m(track, path)) < 1.5, "on its road"
    assert min(arrived) <= 20_000
    assert 0 <= end_ms - max(arrived) - 1000 <= 1500, "complete when the last has stood a second"
    assert not [s for s in flight.of("ServiceStatus") if s.StatusType.name != "Information"]


def test_nobody_leaves_before_the_last_has_come_and_then_all_go_on(tmp_path: Path) -> None:
    """Their plans have a second cordon; by itself the first to come would not stand for so long."""
    flight = driven(tmp_path, 220.0, cordon(), cordon(101, NEXT), TaskRelationships=IN_TURN)
    ends, first, second = complete(flight), places(flight, 100), places(flight, 101)
    assert ends[100] < ends[101]
    came = {}
    for vehicle in (1, 2):
        away = away_m(flight, vehicle, first[vehicle])
        came[vehicle] = next(time for time, far in away if far < 1)
        assert max(far for time, far in away if came[vehicle] <= time <= ends[100]) < 1
        assert away[-1][1] > 100, "and then it goes on"
        assert away_m(flight, vehicle, second[vehicle])[-1][1] < 1
    assert abs(came[1] - came[2]) > 10_000


def test_who_stands_is_sent_on_when_the_task_is_removed_and_who_comes_goes_on(
    tmp_path: Path,
) -> None:
    task = cordon(Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="30000")])
    removed = (39.0, lmcp.new("RemoveTasks", TaskList=[100]))
    flight = driven(
        tmp_path, 320.0, task, cordon(101, NEXT), said=[removed], TaskRelationships=IN_TURN
    )
    first = places(flight, 100)
    assert [
        t for v, p in first.items() for t, far in away_m(flight, v, p) if far < 1 and t < 39_000
    ]
    told = [(s, e.body) for s, e in flight.told if e.topic.endswith("VehicleActionCommand")]
    (on,) = [body for s, body in told if 39 <= s < 40]
    assert type(on.VehicleActionList[0]).__name__ == "GoToWaypointAction"
    assert list(complete(flight)) == [101]
    stood = [
        s.Time for s in states(flight, 3 - on.VehicleID) if s.Groundspeed == 0 and s.Time > 38e3
    ]
    assert stood[-1] - stood[0] > 30_000, "for as long as its plan says"


WINDOW = "p100_[120000-400000]"


def test_who_has_to_wait_stands_where_its_way_begins(tmp_path: Path) -> None:
    flight = driven(tmp_path, 180.0, cordon(), TaskRelationships=WINDOW)
    assert 120_000 < complete(flight)[100] < 140_000
    for vehicle, place in places(flight, 100).items():
        assert away_m(flight, vehicle, place)[-1][1] < 1
        moves = [s.Time for s in states(flight, vehicle) if s.Groundspeed]
        assert 60_000 < moves[0] < 120_000, "it stands until it has to go"
    assert min(body.TimeTaskActivated for body in flight.of("TaskActive")) > 60_000


def test_who_is_at_its_place_from_the_start_counts_when_its_wait_is_over(tmp_path: Path) -> None:
    flight = driven(tmp_path, 130.0, cordon(north=0.0026, radius_m=22.2), TaskRelationships=WINDOW)
    assert all(away_m(flight, v, p)[0][1] < 5 for v, p in places(flight, 100).items())
    assert 120_000 < complete(flight)[100] < 130_000
