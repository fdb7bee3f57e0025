"""Two processes, each of one vehicle, plan one request together; what passes between them passes by hand."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import aircraft
from pipeline_tools import Rig, must_fly, place, request

from cratous.bridge import lmcp
from cratous.services.pipeline.coordinator import MOST

OWN, OTHER = 100, 101
"""Vehicles: the one whose EntityID a process of these tests has, and another."""
TASKS = "Task services"


def asked(number: int = 7, limit: int = 5_000, **more: Any) -> Any:
    """Both are asked to fly to two places."""
    original = request(5, 6, vehicles=(OWN, OTHER), **more)
    return lmcp.new(
        "CoordinatedAutomationRequest",
        RequestID=number,
        MaximumResponseTime=limit,
        OriginalRequest=original,
    )


def told(entity: int, number: int = 7, at: Any = None, heading: float = 0.0) -> Any:
    """Where an entity plans a request from."""
    state = lmcp.new(
        "PlanningState",
        EntityID=entity,
        PlanningPosition=place(0.001) if at is None else at,
        PlanningHeading=heading,
    )
    return lmcp.new(
        "AssignmentCoordination", CoordinatedAutomationRequestID=number, PlanningState=state
    )


def joined(folder: Path, *, own: bool = True) -> Rig:
    """A process with a coordinator that knows both vehicles, and the tasks."""
    folder.mkdir(exist_ok=True)
    rig = Rig(folder)
    configuration, state = aircraft(OWN, 0.0)
    rig.tell(configuration, *aircraft(OTHER, 0.001), must_fly(5), must_fly(6, 0.02, 0.01))
    if own:
        rig.tell(state)
    rig.tell(lmcp.new("AssignmentCoordinatorTask", TaskID=9))
    return rig


def went_out(rig: Rig) -> list[Any]:
    return rig.got("TaskAutomationRequest")


@pytest.mark.shows(TASKS, "AssignmentCoordination", "TaskAutomationRequest")
def test_a_request_goes_out_when_all_have_told_and_its_answer_is_the_plan(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(asked())
    (mine,) = rig.got("AssignmentCoordination")
    assert (mine.CoordinatedAutomationRequestID, mine.PlanningState.EntityID) == (7, OWN)
    assert mine.PlanningState.PlanningPosition == place(0.0)
    rig.wait(4_000)
    assert not went_out(rig), "the other one has not told yet"
    rig.tell(told(OTHER))
    (out,) = went_out(rig)
    assert [s.EntityID for s in out.PlanningStates] == [OWN, OTHER]
    assert list(out.OriginalRequest.EntityList) == [OWN, OTHER]
    (answer,) = rig.got("TaskAutomationResponse")
    (plan,) = rig.got("AutomationResponse")
    assert plan == answer.OriginalResponse
    assert {c.VehicleID for c in plan.MissionCommandList} <= {OWN, OTHER}
    assert plan.MissionCommandList
    rig.wait(60_000)
    assert len(went_out(rig)) == 1, "once"


def test_two_processes_that_tell_each_other_plan_the_same(tmp_path: Path) -> None:
    """The second is the same process seen from the other vehicle: what was told here comes from outside there."""
    one, two = joined(tmp_path / "one"), joined(tmp_path / "two", own=False)
    one.tell(told(OTHER), asked())
    (mine,) = one.got("AssignmentCoordination", "AssignmentCoordinatorTaskService[9]")
    brought = asked().copy(PlanningStates=[told(OTHER).PlanningState])
    two.tell(aircraft(OWN, 0.0)[1], brought)
    assert mine == two.got("AssignmentCoordination")[0]
    assert went_out(one)[0] == went_out(two)[0]
    plans = [rig.got("AutomationResponse")[0].MissionCommandList for rig in (one, two)]
    assert plans[0] == plans[1]


def test_who_does_not_tell_in_time_is_left_out_by_name(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(asked())
    rig.wait(4_999)
    assert not went_out(rig)
    rig.wait(1)
    (out,) = went_out(rig)
    assert list(out.OriginalRequest.EntityList) == [OWN]
    assert any("left out: 101" in text for text in rig.reasons("Warning"))
    assert [c.VehicleID for c in rig.got("AutomationResponse")[0].MissionCommandList] == [OWN]
    rig.tell(told(OTHER))
    assert len(went_out(rig)) == 1, "too late"


def test_without_a_limit_it_waits(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(asked(limit=-1))
    rig.wait(10**6)
    assert not went_out(rig)
    rig.tell(told(OTHER))
    assert went_out(rig)


def test_its_own_state_is_waited_for_and_nobody_is_an_error(tmp_path: Path) -> None:
    rig = joined(tmp_path, own=False)
    rig.tell(asked(), asked(8, limit=100))
    assert any("no state of entity 100" in text for text in rig.reasons("Warning"))
    rig.wait(200)
    assert any("request 8: nobody is left to plan for" in text for text in rig.reasons())
    rig.tell(aircraft(OWN, 0.0)[1], told(OTHER))
    (out,) = went_out(rig)
    assert out.RequestID == 7


@pytest.mark.parametrize(
    ("bad", "reason"),
    [
        (asked().copy(OriginalRequest=request(5)).copy(OriginalRequest=lmcp.new("AutomationRequest", TaskList=[5])), "got 0"),
        (asked().copy(OriginalRequest=request(5, vehicles=tuple(range(2_000)))), "got 2000"),
    ],
)  # fmt: skip
def test_a_request_of_nobody_or_of_too_many_is_refused(
    tmp_path: Path, bad: Any, reason: str
) -> None:
    rig = joined(tmp_path)
    rig.tell(bad)
    assert any(reason in text for text in rig.reasons()), rig.reasons()
    assert not went_out(rig)


def test_what_cannot_be_planned_is_answered_with_the_reason(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(asked(), told(OTHER, heading=math.inf))
    assert any("not a heading" in text for text in rig.reasons()), rig.reasons()
    (answer,) = rig.got("AutomationResponse")
    assert not answer.MissionCommandList
    rig.tell(asked(8), told(OTHER, 8))
    assert rig.got("AutomationResponse")[-1].MissionCommandList


def test_no_number_of_strange_requests_pushes_out_one_that_is_waited_for(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(asked())
    rig.tell(*(told(OTHER, 1_000 + k) for k in range(2 * MOST)))
    rig.tell(asked())
    assert any("request 7 comes again" in text for text in rig.reasons("Warning"))
    rig.tell(told(OTHER))
    assert len(went_out(rig)) == 1
    # of those that are waited for the oldest make room, which is said
    rig.tell(*(asked(2_000 + k, limit=-1) for k in range(MOST + 1)))
    assert any("request 2000: too many are waited for" in text for text in rig.reasons())


def test_a_coordinator_that_is_removed_does_nothing(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.tell(lmcp.new("RemoveTasks", TaskList=[9]))
    rig.tell(asked(), told(OTHER))
    assert not went_out(rig)


def test_a_request_to_fly_it_is_answered_with_its_kind(tmp_path: Path) -> None:
    rig = joined(tmp_path)
    rig.wait(2_000)
    rig.tell(request(9, vehicles=(OWN,)))
    assert any("AssignmentCoordinatorTask" in text for text in rig.reasons()), rig.reasons()


TOLD_FIRST = (
    "AirVehicleConfiguration_V", "KeepOutZone_", "OperatingRegion_", "AreaOfInterest_", "LineOfInterest_",
    "AreaSearchTask_", "AngledAreaSearchTask_", "ImpactLineSearchTask_", "LineSearchTask_",
    "AirVehicleState_V", "AssignmentCoordinatorTask", "CoordinatedAutomationRequest",
)  # fmt: skip


@pytest.mark.slow
def test_two_processes_on_the_example_of_openuxas_plan_the_same(
    shared: Path, tmp_path: Path
) -> None:
    folder = shared / "examples/openuxas-shipped/03_Example_DistributedCooperation/MessagesToSend"
    bodies = [
        lmcp.xml.read_file(file, [])[0]
        for kind in TOLD_FIRST
        for file in sorted(folder.glob(f"{kind}*.xml"))
        if "V3000" not in file.name
    ]
    rigs = []
    for entity in (1000, 2000):
        (tmp_path / str(entity)).mkdir()
        rigs.append(Rig(tmp_path / str(entity), entity=entity))
        for body in bodies:
            rigs[-1].tell(body)
    said = [rig.got("AssignmentCoordination")[0] for rig in rigs]
    assert not any(went_out(rig) for rig in rigs)
    for rig, other in zip(rigs, reversed(said), strict=True):
        rig.tell(other)
    one, two = (rig.got("AutomationResponse")[0].MissionCommandList for rig in rigs)
    assert one == two
    assert [c.VehicleID for c in one] == [1000, 2000]
    flown = {t for c in one for w in c.WaypointList for t in w.AssociatedTasks}
    assert flown == {20, 21, 30, 50, 51}
