"""Tasks of kinds that we do not do: named at once, or done by a service of another's that speaks for them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import option, options, unique
from pipeline_tools import Rig, must_fly, place, request, vehicle

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.pipeline.unserved import OTHERS_MS

KIND = "afrl.impact.CommRelayTask"
INFO = "AutomationResponse"


def relay(number: int, **more: Any) -> Any:
    return lmcp.new("CommRelayTask", TaskID=number, DestinationLocation=place(0.03), **more)


class OtherTask:
    """A task's service as another's program would be, by messages alone."""

    subscribes: tuple[str, ...] = (
        "uxas.messages.task.UniqueAutomationRequest",
        "uxas.messages.task.TaskImplementationRequest",
    )

    def __init__(self, task: int, composition: str = "", count: int = 2) -> None:
        self.name, self.task, self.composition = f"OtherTask[{task}]", task, composition
        self.count = count

    def start(self) -> None:
        return None

    def begin(self, state: None) -> tuple[None, Iterable[Any]]:
        return None, [lmcp.new("TaskInitialized", TaskID=self.task)]

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        body = envelope.body
        if hasattr(body, "OriginalRequest"):
            if self.task not in body.OriginalRequest.TaskList:
                return None, ()
            made = [
                option(self.task, n, latitude=0.02 + 0.01 * n, cost=10_000)
                for n in range(1, self.count + 1)
            ]
            return None, [options(body.RequestID, self.task, *made, composition=self.composition)]
        if body.TaskID != self.task:
            return None, ()
        latitude = 0.02 + 0.01 * body.OptionID
        points = [
            lmcp.new(
                "Waypoint",
                Number=body.StartingWaypointID + k,
                NextWaypoint=body.StartingWaypointID + k + 1,
                Latitude=at,
                Altitude=300.0,
                Speed=20.0,
                AssociatedTasks=[self.task] if k else [],
            )
            for k, at in enumerate((latitude, latitude + 0.002))
        ]
        return None, [
            lmcp.new(
                "TaskImplementationResponse",
                ResponseID=body.RequestID,
                CorrespondingAutomationRequestID=body.CorrespondingAutomationRequestID,
                TaskID=self.task,
                OptionID=body.OptionID,
                VehicleID=body.VehicleID,
                TaskWaypoints=points,
                FinalLocation=place(latitude + 0.002),
                FinalTime=max(body.StartTime, body.TimeThreshold) + 10_000,
            )
        ]


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), must_fly(5))
    return rig


def told(rig: Rig, k: int) -> str:
    return " ".join(pair.Value for pair in rig.got(INFO)[k].Info)


def test_a_kind_that_nobody_does_is_named_when_others_had_their_time_to_speak(rig: Rig) -> None:
    rig.tell(relay(9), request(5, 9))
    rig.wait(OTHERS_MS - 1)
    assert not rig.got(INFO), "another's service may still be starting"
    rig.wait(1)
    assert f"task 9 is a {KIND}: no service here does this kind" in told(rig, 0)
    rig.tell(request(9), request(5))
    assert KIND in told(rig, 1), "at once: nobody has spoken since"
    assert rig.got(INFO)[2].MissionCommandList, "the others go on"
    rig.tell(relay(9), request(9))
    assert len(rig.got(INFO)) == 3, "another task of this id has its own time"
    rig.wait(OTHERS_MS)
    assert KIND in told(rig, 3)


def test_where_tasks_are_made_elsewhere_a_request_waits_for_them(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "AutomationRequestValidatorService")
    rig.tell(*vehicle(1), relay(9), request(9))
    rig.wait(OTHERS_MS)
    assert not rig.got(INFO)
    rig.tell(lmcp.new("TaskInitialized", TaskID=9))
    (asked,) = rig.got("UniqueAutomationRequest")
    assert asked.OriginalRequest.TaskList == [9]


@pytest.mark.parametrize("late", [False, True])
def test_a_kind_for_which_another_speaks_takes_part(rig: Rig, late: bool) -> None:
    rig.tell(relay(9))
    if late:
        rig.wait(2 * OTHERS_MS)
    rig.bus.add(OtherTask(9))
    rig.tell(request(5, 9, TaskRelationships=".(p5 p9)"))
    (response,) = rig.got(INFO)
    (command,) = response.MissionCommandList
    flown = [t for w in command.WaypointList for t in w.AssociatedTasks]
    assert list(dict.fromkeys(flown)) == [5, 9]
    (summary,) = rig.got("TaskAssignmentSummary")
    assert [(t.TaskID, t.OptionID) for t in summary.TaskList][1] == (9, 1), "the nearer option"
    rig.tell(lmcp.new("RemoveTasks", TaskList=[9]), request(9))
    assert "task 9 does not exist" in told(rig, 1)


def test_eligibility_and_relations_hold_for_another_s_task_too(rig: Rig) -> None:
    rig.tell(*vehicle(2, 0.5), relay(9, EligibleEntities=[2]))
    rig.bus.add(OtherTask(9))
    rig.tell(request(5, 9, vehicles=(1, 2), TaskRelationships="|(p5 p9)"))
    (summary,) = rig.got("TaskAssignmentSummary")
    assert {t.TaskID: t.AssignedVehicle for t in summary.TaskList} == {5: 1, 9: 2}


def test_a_planner_s_process_without_a_validator_refuses_what_nobody_speaks_for(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path, "RouteAggregatorService")
    rig.tell(*vehicle(1), relay(9), unique(3, 9))
    assert "tasks of type CommRelayTask are not covered" in rig.reasons()[0]
    rig.tell(lmcp.new("TaskInitialized", TaskID=9), unique(4, 9))
    assert len(rig.reasons()) == 1, "it waits for the options of the one who spoke"
    rig.tell(relay(9), unique(5, 9))
    assert len(rig.reasons()) == 2, "another task of this id has not been spoken for"
