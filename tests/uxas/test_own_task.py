"""A task of the user's own kind: the guide is followed to the letter, and what it answers amiss is named."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import must_fly, request, vehicle
from uxas_tools import process

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.pipeline.off_plan import AWAY
from cratous.services.uxas import own_task
from cratous.spec.errors import BadInput

GUIDE = "docs/guides/own-task.md"


class Ring(own_task.OwnTask):
    """The kind of the guide, that nobody can fly."""

    label = "ring"

    def flights(self, task: Any, speed_m_s: float) -> list[own_task.Flight]:
        return []


def pages(root: Path) -> dict[str, str]:
    """The page's files: a name in backticks, then a block."""
    text = (root / GUIDE).read_text()
    return dict(re.findall(r"^`([\w.]+)`[^\n]*:\n```\w+\n(.*?)^```", text, re.M | re.S))


def answered(root: Path, folder: Path, change: tuple[str, str] = ("", ""), **more: Any) -> Any:
    """What is said where the page's files lie in a folder; change: of its Python."""
    folder.mkdir()
    for name, text in pages(root).items():
        if name.endswith(".py"):
            assert change[0] in text
            text = text.replace(*change) if change[0] else text
        # another module for each folder: what is imported stays
        (folder / name.replace("ring_task", folder.name)).write_text(
            text.replace("ring_task", folder.name)
        )
    said: list[Any] = []
    with process(folder / "cfg.xml", virtual=True)[0] as one:
        one.bus.tap(lambda envelope: said.append(envelope.body))
        for body in (*vehicle(1), *vehicle(2, 0.01), must_fly(5)):
            one.bus.publish(body, "test")
        one.run(1.0)
        one.bus.publish(request(7, 5, vehicles=(1, 2), **more), "test")
        one.run(20.0)
        (response,) = of(said, "AutomationResponse")
        for command in response.MissionCommandList:
            (state,) = (s for s in of(said, "AirVehicleState") if command.VehicleID == s.ID)
            for time_ms, tasks in ((21_000, [7]), (22_000, [7]), (23_000, [])):
                if any(7 in w.AssociatedTasks for w in command.WaypointList):
                    one.bus.publish(state.copy(AssociatedTasks=tasks, Time=time_ms), "test")
        one.bus.publish(lmcp.new("RemoveTasks", TaskList=[7]), "test")
        one.run(21.0)
    return said


def of(said: list[Any], kind: str) -> list[Any]:
    return [body for body in said if type(body).__name__ == kind]


def test_the_guide_makes_a_task_that_is_planned_beside_ours(root: Path, tmp_path: Path) -> None:
    assert len(pages(root)["ring_task.py"].splitlines()) <= 40
    said = answered(root, tmp_path / "as_written")
    (response,) = of(said, "AutomationResponse")
    flown = [w for c in response.MissionCommandList for w in c.WaypointList if w.AssociatedTasks]
    mine = [w for w in flown if w.AssociatedTasks == [7]]
    assert len(mine) == 13
    assert {w.Altitude for w in mine} == {300.0}
    assert max(w.Latitude for w in mine) == pytest.approx(0.03 + 400 / 111_195)
    assert any(w.AssociatedTasks == [5] for w in flown)
    (options,) = (o for o in of(said, "TaskPlanOptions") if o.TaskID == 7)
    assert options.Composition == "+(p1 p2 p3 p4)"
    assert {o.Cost for o in options.Options} == {125_664}
    (active,), (complete,) = of(said, "TaskActive"), of(said, "TaskComplete")
    assert (active.TaskID, active.TimeTaskActivated) == (7, 21_000)
    assert (complete.TaskID, complete.TimeTaskCompleted) == (7, 23_000)


@pytest.mark.parametrize(
    ("name", "change", "reason"),
    [
        ("raises", ('at["Radius_m"] / speed_m_s', "1 / 0"), "task 7: ZeroDivisionError"),
        (
            "no_number",
            ('at["Radius_m"] / speed_m_s', "math.nan"),
            "flights[0].takes_s: out of range",
        ),
        ("no_place", ("ring(at, 1)", "[]"), "flights[0].places: out of range; expected 1 to 10000"),
        ("far_away", ('at["Latitude"] + north', "99 + north"), "99"),
        ("nobody", ("return [clockwise, ", "return [][:0] and ["), "left out: task 7"),
    ],
)
def test_what_such_a_task_answers_amiss_ends_its_request_with_the_reason(
    root: Path, tmp_path: Path, name: str, change: tuple[str, str], reason: str
) -> None:
    said = answered(root, tmp_path / name, change)
    (response,) = of(said, "AutomationResponse")
    assert bool(response.MissionCommandList) == (name == "nobody"), "the other task alone"
    assert any(reason in pair.Value for pair in response.Info), response.Info


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({}, "label: the task kind has no label; expected the Label of its tasks"),
        ({"label": " "}, "label: the task kind has no label"),
        ({"label": None}, "got None"),
        ({"label": "ring", "flights": own_task.OwnTask.flights}, "flights: the task kind says no"),
        ({"label": "ring", "flights": 7}, "flights: the task kind says no flights"),
    ],
)
def test_a_kind_without_label_or_flights_is_refused_with_its_name(
    given: dict[str, Any], reason: str
) -> None:
    """Without a label it would take every task that has none."""
    kind = type("Half", (own_task.OwnTask,), {"flights": Ring.flights, **given})
    with pytest.raises(BadInput) as refused:
        kind("half", {})
    assert str(refused.value).startswith(f"{__name__}:Half: ")
    assert reason in str(refused.value)


def test_such_a_kind_in_a_configuration_is_refused_before_anything_starts(
    root: Path, tmp_path: Path
) -> None:
    with pytest.raises(
        BadInput, match=r"cfg\.xml.*half:RingTask\.label: the task kind has no label"
    ):
        answered(root, tmp_path / "half", ('label = "ring"', 'label = ""'))


def test_a_wait_before_it_is_refused_with_its_length() -> None:
    asked = lmcp.new("TaskImplementationRequest", VehicleID=1, TimeThreshold=9_000)
    route = lmcp.new("RoutePlan", RouteCost=2_000, Waypoints=[lmcp.new("Waypoint")])
    response = lmcp.new("RoutePlanResponse", RouteResponses=[route])
    with pytest.raises(LookupError, match="vehicle 1 would have to wait 7 s for it"):
        own_task._plan(asked, own_task.Flight([own_task.Place(0.0, 0.0)], 1.0), response)


def test_a_task_that_is_removed_while_it_is_flown_is_never_complete() -> None:
    ours = Ring("ring", {})
    flying = {7: lmcp.new("Task", TaskID=7), 8: lmcp.new("Task", TaskID=8)}
    state = own_task.Held(tasks=flying, active={7: 1, 8: 1})
    said: list[Any] = []
    for topic, body in (
        (own_task.REMOVE, lmcp.new("RemoveTasks", TaskList=[7])),
        (own_task.STATE, lmcp.new("AirVehicleState", ID=1, Time=9_000)),
    ):
        state, out = ours.handle(state, Envelope(0, 0, "sim", topic, body), 0)
        said += out
    assert [body.TaskID for body in of(said, "TaskComplete")] == [8]


def test_no_task_ends_while_icarous_has_its_vehicle() -> None:
    ours = Ring("ring", {})
    state = own_task.Held(tasks={7: lmcp.new("Task", TaskID=7)}, active={7: 1})
    owners = {owner: lmcp.new("AuthorityChange", VehicleID=1, Owner=owner) for owner in AWAY}
    seen = lmcp.new("AirVehicleState", ID=1, Mode="FlightDirector", Time=9_000)
    on = seen.copy(Mode="Waypoint", AssociatedTasks=[7])
    said: list[int] = []
    for body in (owners["ICAROUS"], seen, owners["UxAS"], seen, on, on.copy(AssociatedTasks=[])):
        topic = own_task.STATE if hasattr(body, "Mode") else own_task.AUTHORITY
        state, out = ours.handle(state, Envelope(0, 0, "sim", topic, body), 0)
        said.append(len([*out]))
    assert said == [0, 0, 0, 0, 0, 1]


def test_no_task_ends_while_its_vehicle_circles_without_the_link() -> None:
    ours = Ring("ring", {})
    state = own_task.Held(tasks={7: lmcp.new("Task", TaskID=7)}, active={7: 1})
    modes = {m: lmcp.new("LinkLossState", VehicleID=1, Mode=m) for m in ("Loiter", "Linked")}
    seen = lmcp.new("AirVehicleState", ID=1, Mode="Loiter", Time=9_000)
    on = seen.copy(Mode="Waypoint", AssociatedTasks=[7])
    taken = lmcp.new("AuthorityChange", VehicleID=1, Owner="ICAROUS")
    back = lmcp.new("AuthorityChange", VehicleID=1, Owner="UxAS")
    topics = {"LinkLossState": own_task.ALONE, "AuthorityChange": own_task.AUTHORITY}
    said: list[int] = []
    for body in (
        *(modes["Linked"], on, modes["Loiter"], seen, modes["Linked"], seen),
        *(modes["Loiter"], taken, modes["Linked"], seen, on.copy(AssociatedTasks=[]), back),
        *(on, on.copy(AssociatedTasks=[])),
    ):
        topic = topics.get(type(body).__name__, own_task.STATE)
        state, out = ours.handle(state, Envelope(0, 0, "sim", topic, body), 0)
        said.append(len([*out]))
    assert said == [0] * 13 + [1]
