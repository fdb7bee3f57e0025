"""Tasks that begin and end between two states of their vehicle, so that no state lists them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from following_tools import aircraft
from pipeline_tools import Rig, must_fly, request, vehicle
from uxas_flight import fly
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.loading.uxas_cfg import PIPELINE
from cratous.services.simulator.world import Event, World
from cratous.services.uxas.own_task import Flight, OwnTask, Place

LIFE = ("TaskActive", "TaskComplete")


class Ring(OwnTask):
    """A task of the user's own kind."""

    label = "ring"

    def flights(self, task: Any, speed_m_s: float) -> list[Flight]:
        return [Flight([Place(0.02, 0.0)], 1.0)]


def said(rig: Rig) -> list[tuple[str, int, int]]:
    """What is told of the lives of tasks, and of which time."""
    bodies = [e.body for e in rig.all if e.topic.rpartition(".")[2] in LIFE]
    times = [getattr(b, "TimeTaskActivated", getattr(b, "TimeTaskCompleted", 0)) for b in bodies]
    return [(type(b).__name__, b.TaskID, t) for b, t in zip(bodies, times, strict=True)]


def planned(folder: Path, before: int) -> tuple[Rig, Any, list[int], int]:
    """Two tasks in the plan of a vehicle that reported a command before: a state of it, the first task's waypoints,
    and the number of the first one beyond.
    """
    rig = Rig(folder)
    configuration, state = vehicle(1)
    state = state.copy(CurrentCommand=before, Mode="Waypoint", CurrentWaypoint=1)
    rig.tell(configuration, state, must_fly(5), must_fly(6, 0.05))
    rig.tell(request(5, 6, TaskRelationships=".(p5 p6)"))
    (command,) = rig.got("AutomationResponse")[0].MissionCommandList
    mine = [w.Number for w in command.WaypointList if 5 in w.AssociatedTasks]
    return rig, state.copy(CurrentCommand=command.CommandID), mine, mine[-1] + 1


def flown(rig: Rig, state: Any, *seen: tuple[int, int]) -> None:
    """States half a second apart, by waypoint and command."""
    for k, (waypoint, command) in enumerate(seen, 1):
        rig.tell(state.copy(CurrentWaypoint=waypoint, CurrentCommand=command, Time=500 * k))


@pytest.mark.parametrize("seen", [1, 0])
def test_a_task_that_no_state_lists_is_active_and_complete_with_the_one_beyond(
    tmp_path: Path, seen: int
) -> None:
    """Also if that is the first state of the plan; and once."""
    rig, state, _, beyond = planned(tmp_path, 77)
    mine = state.CurrentCommand
    flown(rig, state, *[(1, mine)] * seen, (beyond, mine), (beyond + 1, mine))
    at = 500 * (seen + 1)
    assert said(rig) == [("TaskActive", 5, at), ("TaskComplete", 5, at)]


@pytest.mark.parametrize(
    ("before", "seen"),
    [
        (1, [(1, 1), ("beyond", 1)]),
        (77, [(1, 77), ("beyond", 77)]),
        (77, [(1, 1), ("beyond", 2)]),
        (77, [(1, 1), (999, 1)]),
    ],
    ids=["the plan before had the same number", "that plan is flown on", "sent on", "elsewhere"],
)
def test_a_task_of_which_it_is_not_known_that_it_was_flown_is_not_said_to_be(
    tmp_path: Path, before: int, seen: Sequence[tuple[Any, int]]
) -> None:
    rig, state, _, beyond = planned(tmp_path, before)
    assert state.CurrentCommand == 1
    flown(rig, state, *((beyond if at == "beyond" else at, number) for at, number in seen))
    assert not said(rig)


def test_a_vehicle_that_circles_has_not_passed_its_task(tmp_path: Path) -> None:
    rig, state, _, beyond = planned(tmp_path, 77)
    flown(rig, state.copy(Mode="Loiter"), (1, 1), (beyond, 1))
    assert not said(rig)


def test_a_task_of_a_users_own_kind_that_no_state_lists_is_active_and_complete_too() -> None:
    ring, now = Ring("ring", {}), [0]
    state = ring.start()

    def hear(body: Any) -> list[Any]:
        nonlocal state
        now[0] += 1
        topic = body.all_names[0]
        state, out = ring.handle(state, Envelope(now[0], 0, "test", topic, body), 0)
        return [one for one in out if type(one).__name__ in LIFE]

    configuration, here = vehicle(1)
    points = [
        lmcp.new("Waypoint", Number=n, AssociatedTasks=[7] if n in (2, 3) else [])
        for n in range(1, 6)
    ]
    command = lmcp.new(
        "MissionCommand", CommandID=4, VehicleID=1, WaypointList=points, FirstWaypoint=1
    )
    here = here.copy(Mode="Waypoint", CurrentCommand=3, CurrentWaypoint=5)
    for body in (configuration, here, lmcp.new("Task", TaskID=7, Label="ring")):
        assert not hear(body)
    assert not hear(lmcp.new("AutomationResponse", MissionCommandList=[command]))
    assert not hear(here), "still the plan before"
    assert not hear(here.copy(CurrentCommand=4, CurrentWaypoint=1))
    beyond = here.copy(CurrentCommand=4, CurrentWaypoint=4, Time=9)
    assert [type(one).__name__ for one in hear(beyond)] == list(LIFE)
    assert not hear(beyond)


def test_entities_that_nobody_configured_take_no_memory_of_a_users_own_kind() -> None:
    ring = Ring("ring", {})
    state = ring.start()
    for number in range(1, 400):
        for body in vehicle(number)[number % 2 :]:
            state, _ = ring.handle(state, Envelope(0, 0, "test", body.all_names[0], body), 0)
    assert set(state.commands) == set(range(2, 400, 2))


def test_of_points_nearer_than_a_vehicle_flies_between_states_each_is_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The simulator's states of every second second alone are heard."""
    tick = World.tick

    def seldom(world: World) -> list[Any]:
        return [body for body in tick(world) if getattr(body, "Time", 0) % 2000 == 0]

    monkeypatch.setattr(World, "tick", seldom)
    kinds = (*PIPELINE, "WaypointPlanManagerService")
    attributes = {"WaypointPlanManagerService": 'VehicleID="1"'}
    text = "".join(f'<Service Type="{kind}" {attributes.get(kind, "")}/>\n' for kind in kinds)
    events = [Event(0.1 * k, body, "") for k, body in enumerate(aircraft(1, 0.0))]
    tasks = [must_fly(5 + k, 0.02 + 0.0002 * k) for k in range(4)]
    asked = request(5, 6, 7, 8, TaskRelationships=".(p5 p6 p7 p8)")
    flight = fly(
        write_cfg(tmp_path, text), events, 300.0, [*((1.0, one) for one in tasks), (3.0, asked)]
    )
    listed = {t for body in flight.states(1) for t in body.AssociatedTasks}
    assert listed < {5, 6, 7, 8}, "else this tests nothing"
    lives = [e.body for _, e in flight.told if e.topic.rpartition(".")[2] in LIFE]
    told = [(type(body).__name__, body.TaskID) for body in lives]
    assert sorted(told) == sorted((kind, task) for task in (5, 6, 7, 8) for kind in LIFE)
    for task in (5, 6, 7, 8):
        assert told.index(("TaskActive", task)) < told.index(("TaskComplete", task))


@pytest.mark.shows("Task services", "MissionCommand")
@pytest.mark.parametrize("kind", ["MissionCommand", "AutomationResponse"])
def test_a_task_ends_undone_with_the_mission_of_its_vehicle(tmp_path: Path, kind: str) -> None:
    rig, state, mine, _ = planned(tmp_path, 77)
    rig.tell(state.copy(CurrentWaypoint=mine[0], AssociatedTasks=[5]))
    rig.tell(lmcp.new("MissionCommand", VehicleID=2))
    assert not rig.reasons("Warning"), "of another vehicle"
    over = lmcp.new("MissionCommand", VehicleID=1)
    if kind == "AutomationResponse":
        over = lmcp.new("AutomationResponse", MissionCommandList=[over])
    rig.tell(over, state.copy(Mode="Loiter"))
    ended = [text for text in rig.reasons("Warning") if "ends undone" in text]
    assert [text[:6] for text in ended] == ["task 5", "task 6"]
    assert not rig.got("TaskComplete")


def test_a_task_of_a_users_own_kind_ends_undone_too() -> None:
    ring = Ring("ring", {})
    state = ring.start()
    listed = vehicle(1)[1].copy(AssociatedTasks=[7])
    over = lmcp.new("MissionCommand", VehicleID=1)
    said = list[Any]()
    for body in (
        lmcp.new("Task", TaskID=7, Label="ring"),
        listed,
        over,
        listed.copy(AssociatedTasks=[]),
    ):
        state, out = ring.handle(state, Envelope(0, 0, "test", body.all_names[0], body), 0)
        said += [type(one).__name__ for one in out]
    assert said == ["TaskInitialized", "TaskActive", "ServiceStatus"]
