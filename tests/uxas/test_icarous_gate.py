"""What UxAS's end of the bridge tells of each vehicle's gate, judged as a log is."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from bridge_flight import PLANE, TASK, Aircraft, way
from icarous_rig import Rig, state

from cratous.bridge import text_protocol as tp
from cratous.spec.mission.guarantees import Outcome

SERVICE = "IcarousCommunicationService"


@pytest.mark.shows(SERVICE, "GatedCommand")
@pytest.mark.parametrize("during", [False, True], ids=["none", "during the takeover"])
def test_the_commands_at_its_gate_tell_the_story_of_authority(
    tmp_path: Path, opened: list[Any], during: bool
) -> None:
    """A takeover with its handback is judged as one; a mission that comes meanwhile is a second commander."""
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    one = rig.fake(hello=1)
    one.say(tp.SetMode("PASSIVE", 0))
    rig.until(lambda: rig.process.bus.state(SERVICE).fresh == frozenset())
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)), state(1, 1.0, 1500))
    one.say(tp.SetMode("ACTIVE", 1), tp.SetVelocity(0.0, 20.0, 0.0))
    rig.until(lambda: rig.got("VehicleActionCommand"))
    if during:
        rig.tell(way((0.0, 0.0), (0.0, 700.0)))
        rig.until(lambda: rig.said.has("waits for the handback"))
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    senders = [(c.Sender.name, c.Epoch) for c in rig.got("GatedCommand")]
    meanwhile = [("UxAS", 1)] if during else []
    assert senders == [("UxAS", 0), ("ICAROUS", 1), *meanwhile, ("UxAS", 2)]
    assert [c.Command for c in rig.got("GatedCommand")][-1] == rig.got("MissionCommand")[-1]
    verdict = rig.authority()
    assert verdict.outcome is (Outcome.VIOLATED if during else Outcome.HOLDS), verdict.note
    assert ("without authority" if during else "1 takeover, each handed back") in verdict.note


def test_what_a_vehicle_flies_when_its_instance_comes_comes_to_its_gate(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    told = way((0.0, 0.0), (900.0, 0.0))
    rig.tell(state(1), told)
    assert not rig.got("GatedCommand")
    one = rig.fake(hello=1)
    rig.tell(told)
    assert not rig.got("GatedCommand"), "told in an epoch that is not known yet"
    one.say(tp.SetMode("PASSIVE", 0))
    rig.until(lambda: rig.got("GatedCommand"))
    (come,) = rig.got("GatedCommand")
    assert (come.Sender.name, come.Epoch, come.Command) == ("UxAS", 0, told)


@pytest.mark.parametrize("tasks", [[TASK], []], ids=["searching", "on the way"])
def test_only_who_was_doing_a_task_comes_back_to_where_its_way_was_left(
    tmp_path: Path, opened: list[Any], tasks: list[int]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1" DeviationAllowed="40" DeviationOrigin="path"', opened)
    one = rig.fake(hello=1)

    def at(north: float, east: float, now_ms: int, waypoint: int = 2) -> Any:
        craft = Aircraft(1, north, east, 0.0)
        craft.waypoint = waypoint
        return craft.state(now_ms).copy(AssociatedTasks=tasks)

    rig.tell(at(-300.0, 0.0, 1000, 1), way((0.0, 0.0), (9000.0, 0.0)), at(-200.0, 0.0, 2000, 1))
    rig.tell(at(500.0, 0.0, 4000))
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.got("AuthorityChange"))
    rig.tell(at(3000.0, 600.0, 120_000))
    assert [p.TaskID for p in rig.got("TaskPause")] == tasks
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    (command,) = rig.got("MissionCommand")
    added = [w for w in command.WaypointList if w.Number > 2]
    places = [PLANE.to_local(w.Latitude, w.Longitude) for w in added]
    assert any(math.dist(place, (500.0, 0.0)) < 50.0 for place in places) == bool(tasks), places
    assert (added[-1].NextWaypoint if added else command.FirstWaypoint) == 2


@pytest.mark.parametrize("begun", [False, True])
def test_a_task_pauses_where_its_first_waypoint_is_behind(
    tmp_path: Path, opened: list[Any], begun: bool
) -> None:
    """A state bears the task's number already while the waypoint is made for at which the task begins."""
    rig = Rig(tmp_path, 'NumberOfUAVs="1" DeviationAllowed="40" DeviationOrigin="path"', opened)
    one = rig.fake(hello=1)
    plan = way((0.0, 0.0), (2000.0, 0.0), (9000.0, 0.0))
    plan.WaypointList[0].AssociatedTasks = []  # the task begins at the second

    def at(north: float, east: float, now_ms: int, waypoint: int) -> Any:
        craft = Aircraft(1, north, east, 0.0)
        craft.waypoint = waypoint
        tasks = [TASK] if waypoint > 1 else []
        return craft.state(now_ms).copy(AssociatedTasks=tasks)

    goal, north = (3, 4000.0) if begun else (2, 500.0)
    rig.tell(at(-300.0, 0.0, 1000, 1), plan, at(-200.0, 0.0, 2000, 1), at(100.0, 0.0, 3000, 2))
    rig.tell(at(north, 0.0, 4000, goal))
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.got("AuthorityChange"))
    rig.tell(at(north + 900.0, 600.0, 120_000, goal))
    assert [p.TaskID for p in rig.got("TaskPause")] == [TASK] * begun
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    (command,) = rig.got("MissionCommand")
    added = [w for w in command.WaypointList if w.Number > 3]
    places = [PLANE.to_local(w.Latitude, w.Longitude) for w in added]
    assert any(math.dist(place, (north, 0.0)) < 50.0 for place in places) is begun, places
    assert [p.TaskID for p in rig.got("TaskResume")] == [TASK] * begun


@pytest.mark.parametrize("handed_on", [False, True], ids=["way back", "part of the way"])
def test_a_task_that_was_begun_is_being_done_on_the_way_that_follows_too(
    tmp_path: Path, opened: list[Any], handed_on: bool
) -> None:
    """None of the waypoints that bear its number is behind on that way."""
    rig = Rig(tmp_path, 'NumberOfUAVs="1" DeviationAllowed="40" DeviationOrigin="path"', opened)
    one = rig.fake(hello=1)

    def at(north: float, east: float, now_ms: int, waypoint: int) -> Any:
        craft = Aircraft(1, north, east, 0.0)
        craft.waypoint = waypoint
        return craft.state(now_ms).copy(AssociatedTasks=[TASK])

    rig.tell(at(-300.0, 0.0, 1000, 1), way((0.0, 0.0), (3000.0, 0.0), (9000.0, 0.0)))
    rig.tell(at(500.0, 0.0, 2000, 2))
    epoch, goal = 1, 1
    if handed_on:  # as a waypoint manager does
        rig.tell(way((3000.0, 0.0), (9000.0, 0.0)))
    else:
        one.say(tp.SetMode("ACTIVE", 1))
        rig.until(lambda: rig.got("AuthorityChange"))
        rig.tell(at(800.0, 600.0, 30_000, 2))
        one.say(tp.SetMode("PASSIVE", 2))
        rig.until(lambda: rig.got("MissionCommand"))
        (command,) = rig.got("MissionCommand")
        epoch, goal = 3, command.FirstWaypoint
    pauses, changes = len(rig.got("TaskPause")), len(rig.got("AuthorityChange"))
    rig.tell(at(800.0, 600.0, 31_000, goal))
    one.say(tp.SetMode("ACTIVE", epoch))
    rig.until(lambda: len(rig.got("AuthorityChange")) > changes)
    rig.tell(at(800.0, 5000.0, 60_000, goal))
    assert [p.TaskID for p in rig.got("TaskPause")[pauses:]] == [TASK]
