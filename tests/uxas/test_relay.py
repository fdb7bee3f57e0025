"""A relay between a radio tower and what moves, flown in the simulator, and what it cannot be."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import ENTITY, aircraft, moving
from pipeline_tools import PIPELINE, Rig, must_fly, place, request
from uxas_flight import fly, local
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.simulator.world import Event

TOWER, RANGE_M = 21, 2_000.0
TOWER_AT = (0.03, -0.015)


def tower(**more: Any) -> Any:
    values = {"ID": TOWER, "Position": place(*TOWER_AT), "Range": RANGE_M, **more}
    return lmcp.new("RadioTowerConfiguration", **values)


def relay(**more: Any) -> Any:
    values = {"TaskID": 5, "SupportedEntityID": ENTITY, "TowerID": TOWER, **more}
    return lmcp.new("CommRelayTask", **values)


def minute() -> list[Any]:
    return [lmcp.new("KeyValuePair", Key="Duration_ms", Value="60000")]


def in_reach(body: Any, entity: Any) -> bool:
    """Whether a vehicle, by its state, was in reach of the tower and of the entity, on a plane that touches there."""
    here, there = local([body.Location, entity.Location], place(*TOWER_AT))
    return max(math.hypot(*here), math.dist(here, there)) <= RANGE_M + 10


@pytest.mark.shows("Task services", "TaskActive", "VehicleActionCommand")
def test_a_relay_stays_in_reach_of_the_tower_and_of_what_moves(tmp_path: Path) -> None:
    kinds = (*PIPELINE, "WaypointPlanManagerService")
    text = "".join(
        f'<Service Type="{kind}" {"VehicleID=" + chr(34) + "1" + chr(34) if "Way" in kind else ""}/>\n'
        for kind in kinds
    )
    bodies = [*moving(), *aircraft(1, 0.0), *aircraft(2, 0.1)]
    events = [Event(0.1 * k, body, "") for k, body in enumerate(bodies)]
    tasks = [relay(Parameters=minute(), EligibleEntities=[1, ENTITY]), must_fly(6, 0.0, 0.01)]
    said = [(0.9, tower()), *((1.0, one) for one in tasks)]
    said.append((3.0, request(5, 6, vehicles=(1, 2), TaskRelationships=".(p5 p6)")))
    flight = fly(write_cfg(tmp_path, text), events, 420.0, said)
    complete = flight.of("TaskComplete")[0]
    assert (complete.TaskID, complete.EntitiesInvolved) == (5, [1])
    end = complete.TimeTaskCompleted
    where = {body.Time: body for body in flight.states(ENTITY)}
    kept = [
        in_reach(body, where[body.Time])
        for body in flight.states(1)
        if body.Time in where and end - 60_000 <= body.Time <= end
    ]
    assert len(kept) > 100
    assert all(kept), "for the whole minute"
    circling = [s for s in flight.states(1) if s.Mode.name == "Loiter"]
    moved = local([circling[0].Location, circling[-1].Location], place(*TOWER_AT))
    assert moved[1].x - moved[0].x > 100, "it moves as what it supports moves"


def told(folder: Path, task: Any, *more: Any) -> Rig:
    """What is said of a request with this task."""
    folder.mkdir(exist_ok=True)
    rig = Rig(folder)
    rig.tell(*aircraft(1, 0.0), *moving(), *more, task, request(5))
    return rig


@pytest.mark.parametrize(
    ("task", "tower_", "reason"),
    [
        (
            relay(TowerID=7),
            tower(),
            "a radio tower of which no message has told; expected one of 21; got 7",
        ),
        (relay(), tower(Range=0.0), "Range of tower 21: out of range"),
        (relay(), tower(Position=place(99.0)), "place of tower 21: not a place"),
        (relay(SupportedEntityID=77), tower(), "an entity of which no message has told"),
        (relay(SupportedEntityID=0), tower(), "it supports nothing"),
        (relay(), tower(Range=500.0), "not in reach of both, of 500 m"),
        (relay(SupportedEntityID=1), tower(), "the task keeps to this very one"),
    ],
)
def test_what_cannot_be_relayed_is_refused_with_what_and_where(
    tmp_path: Path, task: Any, tower_: Any, reason: str
) -> None:
    rig = told(tmp_path, task, tower_)
    said = rig.reasons() + rig.reasons("Warning")
    assert any(reason in text for text in said), said
    rig.tell(must_fly(6), request(6))
    assert rig.got("AutomationResponse")[-1].MissionCommandList


def circled(rig: Rig) -> Any:
    """The circle that the vehicle was told last."""
    return rig.got("VehicleActionCommand")[-1].VehicleActionList[0]


def under_way(rig: Rig, **more: Any) -> Any:
    """A state of the vehicle as it makes for its circle."""
    assert not rig.reasons(), rig.reasons()
    state = aircraft(1, 0.03)[1].copy(
        Location=place(0.03, -0.0065), Mode="Waypoint", CurrentWaypoint=99, AssociatedTasks=[5],
        Time=1000, **more,
    )  # fmt: skip
    rig.tell(state)
    return state


def test_a_place_is_supported_where_no_entity_is(tmp_path: Path) -> None:
    where = {"SupportedEntityID": 0, "DestinationLocation": place(0.03, 0.002)}
    rig = told(tmp_path, relay(Parameters=minute(), **where), tower())
    state = under_way(rig)
    at = circled(rig).Location
    assert math.hypot(*local([at], place(0.03, -0.0065))[0]) < 5, "halfway"
    # nobody has to tell where it is: the minute counts
    number = rig.got("VehicleActionCommand")[-1].CommandID
    for k in range(2, 62):
        assert not rig.got("TaskComplete")
        rig.tell(state.copy(Mode="Loiter", CurrentCommand=number, Time=1000 * k))
    assert rig.got("TaskComplete")


def test_the_middle_moves_half_as_fast_as_what_is_supported(tmp_path: Path) -> None:
    """An entity at 30 m/s is relayed by a vehicle that flies 20 m/s, 30 m/s at most; one at 61 m/s is not."""
    rig = Rig(tmp_path)
    rig.tell(*aircraft(1, 0.029), *moving(30.0), tower(Range=50_000.0), relay(), request(5))
    assert rig.got("AutomationResponse")[-1].MissionCommandList, rig.reasons()
    rig.tell(*moving(61.0), request(5))
    assert any("and the tower moves at 30.5 m/s" in text for text in rig.reasons("Warning"))


def test_a_relay_is_planned_to_where_it_is_in_reach_of_both_and_no_farther(tmp_path: Path) -> None:
    """Tower and entity are 3 km apart, 3.3 km north of it."""
    rig = told(tmp_path, relay(), tower(Position=place(0.03, 0.03)), *moving(0.0))
    (option,) = rig.got("TaskPlanOptions")[0].Options
    places = (option.EndLocation, place(0.03, 0.03), place(0.03, 0.002))
    here, *both = local(list(places), place(0.0))
    spare_m = 1.1 * 20**2 / (9.80665 * math.tan(math.radians(30)))
    assert max(math.dist(here, one) for one in both) == pytest.approx(RANGE_M - spare_m, abs=5)


def test_what_gets_out_of_reach_is_said_and_the_time_does_not_count(tmp_path: Path) -> None:
    rig = told(tmp_path, relay(Parameters=minute(), DestinationLocation=place(0.1)), tower())
    assert any("DestinationLocation of task 5 is not used" in t for t in rig.reasons("Warning"))
    state = under_way(rig)
    number = rig.got("VehicleActionCommand")[-1].CommandID
    state = state.copy(Mode="Loiter", CurrentCommand=number)
    entity = moving()[1]
    # the tower is told of no more: it stands where it stood
    rig.tell(lmcp.new("RemoveEntities", EntityList=[TOWER]))
    for k in range(2, 50):
        rig.tell(entity.copy(Time=1000 * k), state.copy(Time=1000 * k))
    rig.tell(entity.copy(Location=place(0.09), Time=50_000), state.copy(Time=50_000))
    assert any("vehicle 1 is no longer in reach" in text for text in rig.reasons("Warning"))
    for k in range(51, 111):
        rig.tell(entity.copy(Time=1000 * k), state.copy(Time=1000 * k))
    assert not rig.got("TaskComplete")
    rig.tell(entity.copy(Time=111_000), state.copy(Time=111_000))
    assert rig.got("TaskComplete")
