"""AutomationRequestValidatorService: which requests pass, in which order, and that each is answered."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp

NAME = "AutomationRequestValidatorService"


@pytest.fixture
def alone(tmp_path: Path) -> Rig:
    """The validator alone: the test plays the rest of the pipeline, so it may be another's."""
    rig = Rig(tmp_path, NAME, **{NAME: 'MaxResponseTime_ms="1000"'})
    rig.tell(*vehicle(1), must_fly(5), lmcp.new("TaskInitialized", TaskID=5))
    return rig


def respond(rig: Rig, number: int) -> None:
    command = lmcp.new("MissionCommand", CommandID=number, VehicleID=1)
    plan = lmcp.new("AutomationResponse", MissionCommandList=[command])
    rig.tell(lmcp.new("UniqueAutomationResponse", ResponseID=number, OriginalResponse=plan))


def infos(rig: Rig) -> list[str]:
    return [" ".join(p.Value for p in body.Info) for body in rig.got("AutomationResponse")]


@pytest.mark.shows(
    NAME,
    "AutomationRequest",
    "UniqueAutomationRequest",
    "UniqueAutomationResponse",
    "AutomationResponse",
    "Task",
    "TaskInitialized",
    "EntityConfiguration",
    "EntityState",
)
def test_one_request_at_a_time_in_order_each_answered_once(alone: Rig) -> None:
    alone.tell(request(5), request(5), request(5))
    assert [u.RequestID for u in alone.got("UniqueAutomationRequest")] == [1]
    (unique,) = alone.got("UniqueAutomationRequest")
    assert unique.OriginalRequest.TaskList == [5]
    assert [s.EntityID for s in unique.PlanningStates] == [1]
    respond(alone, 1)
    assert [u.RequestID for u in alone.got("UniqueAutomationRequest")] == [1, 2]
    respond(alone, 1)  # again: nobody waits for it
    assert len(alone.got("AutomationResponse")) == 1
    assert alone.reasons("Warning") == [
        "a response that nobody waits for (late, or of another request)"
    ]
    respond(alone, 2)
    respond(alone, 3)
    answers = alone.got("AutomationResponse")
    assert [a.MissionCommandList[0].CommandID for a in answers] == [1, 2, 3]


@pytest.mark.shows(NAME, "MaxResponseTime_ms", "ServiceStatus")
def test_time_runs_out_and_the_next_begins_and_a_late_response_is_not_passed_on(
    alone: Rig,
) -> None:
    alone.tell(request(5), request(5))
    alone.wait(999)
    assert not alone.got("AutomationResponse")
    alone.wait(1)
    assert infos(alone) == ["no response within MaxResponseTime_ms = 1000"]
    assert alone.reasons() == ["no response within MaxResponseTime_ms = 1000"]
    assert [u.RequestID for u in alone.got("UniqueAutomationRequest")] == [1, 2]
    respond(alone, 1)
    assert len(alone.got("AutomationResponse")) == 1
    respond(alone, 2)
    assert alone.got("AutomationResponse")[1].MissionCommandList[0].CommandID == 2
    alone.wait(5000)
    assert len(alone.got("AutomationResponse")) == 2


def anew(rig: Rig, limit_ms: int = 1000) -> None:
    """KillService, and another validator."""
    number = next(n for n, name in rig.one.manager.services.items() if name == NAME)
    rig.tell(lmcp.new("KillService", ServiceID=number))
    text = f'<Service Type="{NAME}" MaxResponseTime_ms="{limit_ms}"/>'
    rig.tell(lmcp.new("CreateNewService", XmlConfiguration=text))


def test_started_anew_it_answers_each_request_of_before_once_in_its_turn(alone: Rig) -> None:
    alone.tell(request(5), request(5))
    anew(alone)
    alone.tell(request(5))
    respond(alone, 1)
    anew(alone)
    respond(alone, 1)  # again: it has its answer
    respond(alone, 2)
    respond(alone, 3)
    anew(alone)
    answers = alone.got("AutomationResponse")
    assert [a.MissionCommandList[0].CommandID for a in answers] == [1, 2, 3]
    assert [u.RequestID for u in alone.got("UniqueAutomationRequest")] == [1, 2, 3]
    alone.wait(5000)
    assert len(alone.got("AutomationResponse")) == 3


@pytest.mark.parametrize("limit_ms", [300, 1000, 4000])
def test_started_anew_it_tells_that_the_time_of_a_request_of_before_ran_out(
    alone: Rig, limit_ms: int
) -> None:
    alone.tell(request(5))
    alone.wait(400)
    anew(alone, limit_ms)
    alone.wait(limit_ms)
    assert infos(alone) == [f"no response within MaxResponseTime_ms = {limit_ms}"]
    respond(alone, 1)
    alone.wait(9000)
    assert len(alone.got("AutomationResponse")) == 1


def test_what_comes_while_it_is_not_there_has_no_answer(alone: Rig) -> None:
    alone.tell(request(5))
    service = alone.bus._services[NAME]
    alone.bus.remove(NAME)
    respond(alone, 1)
    alone.tell(request(5))
    alone.bus.add(service)
    alone.wait(5000)
    assert infos(alone) == ["no response within MaxResponseTime_ms = 1000"]


def test_an_error_status_ends_the_request_that_it_names_and_no_other(alone: Rig) -> None:
    alone.tell(request(5), request(5))

    def error(kind: str, **facts: str) -> Any:
        info = [lmcp.new("KeyValuePair", Key=k, Value=v) for k, v in facts.items()]
        return lmcp.new("ServiceStatus", StatusType=kind, Info=info)

    alone.tell(error("Error", RequestID="77", reason="other"))
    alone.tell(error("Warning", RequestID="1", reason="only a warning"))
    alone.tell(error("Error", RequestID="0", reason="of nothing here"))
    assert not alone.got("AutomationResponse")
    alone.tell(error("Error", RequestID="1", reason="no way"))
    assert infos(alone) == ["no way"]
    # the original's services name no request: theirs is about the one in the pipeline
    alone.tell(error("Error", No_Assignment="so says another"))
    assert infos(alone) == ["no way", "No_Assignment: so says another"]


@pytest.mark.shows(NAME, "RemoveTasks", "OperatingRegion", "AbstractZone")
@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (request(5, vehicles=(9,)), "vehicle 9 does not exist"),
        (request(5, vehicles=(2,)), "the state of vehicle 2 is not known"),
        (request(8), "task 8 does not exist"),
        (request(), "the request names no task"),
        (request(5, OperatingRegion=4), "operating region 4 does not exist"),
        (request(5, OperatingRegion=3), "zone 31 does not exist"),
        (request(51), "task 51 names line 7, which does not exist"),
        (request(52), "task 52 names area 7, which does not exist"),
        (request(53), "task 53 names point 7, which does not exist"),
    ],
)
def test_a_request_that_is_not_valid_is_answered_with_the_reason(
    alone: Rig, asked: Any, words: str
) -> None:
    region = lmcp.new("OperatingRegion", ID=3, KeepInAreas=[30], KeepOutAreas=[31])
    circle = lmcp.new("Circle", CenterPoint=lmcp.new("Location3D"), Radius=9000.0)
    inside = lmcp.new("KeepInZone", ZoneID=30, Boundary=circle)
    searches = [
        lmcp.new("ImpactLineSearchTask", TaskID=51, LineID=7),
        lmcp.new("AngledAreaSearchTask", TaskID=52, SearchAreaID=7),
        lmcp.new("ImpactPointSearchTask", TaskID=53, SearchLocationID=7),
    ]
    alone.tell(*searches, *(lmcp.new("TaskInitialized", TaskID=t.TaskID) for t in searches))
    alone.tell(region, inside, vehicle(2)[0], asked)
    (said,) = infos(alone)
    assert words in said
    assert not alone.got("UniqueAutomationRequest")
    assert len(alone.reasons()) == 1
    # what was missing comes, and it can be planned
    small = circle.copy(CenterPoint=lmcp.new("Location3D", Latitude=0.05))
    far = lmcp.new("KeepOutZone", ZoneID=31, Boundary=small.copy(Radius=100.0))
    alone.tell(far, request(5, OperatingRegion=3))
    assert len(alone.got("UniqueAutomationRequest")) == 1
    respond(alone, alone.got("UniqueAutomationRequest")[0].RequestID)
    alone.tell(lmcp.new("RemoveTasks", TaskList=[5]), request(5))
    assert "task 5 does not exist" in infos(alone)[-1]


ODD = vehicle(3)[0].copy(NominalFlightProfile=lmcp.new("FlightProfile", MaxBankAngle=0.5))


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (request(5, TaskRelationships="|(p5 p6)"), "p6"),
        (request(5, TaskRelationships="|(p5"), "expected"),
        (request(5, vehicles=(3,)), "vehicle 3 cannot turn like that"),
    ],
)
def test_a_valid_request_passes_as_it_is_and_what_cannot_be_planned_the_planners_answer(
    alone: Rig, tmp_path: Path, asked: Any, words: str
) -> None:
    alone.tell(ODD, vehicle(3)[1], asked)
    assert [u.OriginalRequest for u in alone.got("UniqueAutomationRequest")] == [asked]
    assert not alone.got("AutomationResponse")
    respond(alone, 1)  # whoever plans it, by whatever means
    assert alone.got("AutomationResponse")[0].MissionCommandList[0].CommandID == 1
    (tmp_path / "whole").mkdir()
    whole = Rig(tmp_path / "whole")
    whole.tell(*vehicle(1), ODD, vehicle(3)[1], must_fly(5), asked, request(5))
    first, second = whole.got("AutomationResponse")
    assert words in first.Info[0].Value
    assert not first.MissionCommandList
    assert len(whole.reasons()) == 1, "said once, though several services plan"
    assert second.MissionCommandList, "the next one is planned"


def test_a_request_waits_for_its_tasks_to_initialise_themselves_in_its_place_in_the_line(
    alone: Rig,
) -> None:
    alone.tell(must_fly(6), request(6), request(5))
    assert not alone.got("UniqueAutomationRequest")
    alone.tell(lmcp.new("TaskInitialized", TaskID=6))
    assert [u.OriginalRequest.TaskList for u in alone.got("UniqueAutomationRequest")] == [[6]]
    respond(alone, 1)
    respond(alone, 2)
    alone.tell(must_fly(6), request(6))  # another task of this id begins anew
    alone.wait(1000)
    assert "task 6 has not initialised itself" in infos(alone)[2]


@pytest.mark.shows(NAME, "ImpactAutomationRequest", "ImpactAutomationResponse")
def test_a_trial_is_a_sandbox_request_and_gets_its_own_kind_of_response(alone: Rig) -> None:
    trial = lmcp.new(
        "ImpactAutomationRequest", RequestID=70, TrialRequest=request(5), PlayID=8, Sandbox=True
    )
    alone.tell(trial, trial.copy(TrialRequest=request(9)))
    (unique,) = alone.got("UniqueAutomationRequest")
    assert unique.SandBoxRequest
    respond(alone, unique.RequestID)
    answers = alone.got("ImpactAutomationResponse")
    assert [(a.ResponseID, a.PlayID, a.Sandbox) for a in answers] == [(70, 8, True)] * 2
    assert answers[0].TrialResponse.MissionCommandList[0].VehicleID == 1
    assert answers[1].TrialResponse.Info[0].Value == "task 9 does not exist"
    assert not alone.got("AutomationResponse")


@pytest.mark.shows(NAME, "TaskAutomationRequest", "TaskAutomationResponse")
def test_a_task_asks_from_states_of_its_own(alone: Rig) -> None:
    start = lmcp.new("Location3D", Latitude=0.5, Longitude=0.25, Altitude=200.0)
    state = lmcp.new("PlanningState", EntityID=2, PlanningPosition=start, PlanningHeading=90.0)
    body = lmcp.new(
        "TaskAutomationRequest",
        RequestID=7,
        OriginalRequest=request(5, vehicles=(2,)),
        PlanningStates=[state],
    )
    alone.tell(*vehicle(2), body)
    (unique,) = alone.got("UniqueAutomationRequest")
    (planning,) = unique.PlanningStates
    assert planning.PlanningPosition.Latitude == pytest.approx(0.5, abs=1e-7)
    assert planning.PlanningHeading == pytest.approx(90.0)
    final = lmcp.new("UniqueAutomationResponse", ResponseID=unique.RequestID, FinalStates=[state])
    alone.tell(final)
    (response,) = alone.got("TaskAutomationResponse")
    assert response.ResponseID == unique.RequestID == 7
    assert response.FinalStates == [state]
    # its id again, and others': each request has one of its own
    alone.tell(body, request(5), request(5), body.copy(RequestID=2), body.copy(RequestID=-(2**63)))
    for number in (1, 2, 3, 4):
        assert alone.got("UniqueAutomationRequest")[-1].RequestID == number
        respond(alone, number)
    assert alone.got("UniqueAutomationRequest")[-1].RequestID == -(2**63)
    respond(alone, -(2**63))
    assert [a.ResponseID for a in alone.got("TaskAutomationResponse")] == [7, 7, 2, -(2**63)]


def test_no_entity_list_means_all_vehicles(alone: Rig) -> None:
    alone.tell(*vehicle(2), request(5, vehicles=()))
    (unique,) = alone.got("UniqueAutomationRequest")
    assert unique.OriginalRequest.EntityList == []
    assert [state.EntityID for state in unique.PlanningStates] == [1, 2]


def test_tasks_that_the_relations_do_not_name_are_not_done_and_the_response_says_so(
    alone: Rig,
) -> None:
    alone.tell(must_fly(6), lmcp.new("TaskInitialized", TaskID=6))
    alone.tell(request(5, 6, TaskRelationships="p5"))
    (unique,) = alone.got("UniqueAutomationRequest")
    assert unique.OriginalRequest.TaskList == [5]
    respond(alone, 1)
    text = "tasks not named in TaskRelationships, so not done: 6"
    assert infos(alone) == [text]
    assert alone.reasons("Warning") == [text]


def test_ids_do_not_come_twice_when_the_validator_is_made_again(alone: Rig) -> None:
    alone.tell(request(5))
    anew(alone)
    respond(alone, 1)
    alone.tell(request(5))
    assert [u.RequestID for u in alone.got("UniqueAutomationRequest")] == [1, 2]


def test_two_hundred_requests_at_once_are_answered_in_order_and_leave_nothing(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *[loiter(n, 0.02 + 0.001 * n) for n in range(5, 9)])
    rig.tell(request(5))  # everything is made once
    before = len(rig.got("AutomationResponse"))
    order = [5 + k % 4 for k in range(200)]
    seen: list[int] = []
    alive: dict[int, int] = {}

    def watch(envelope: Any) -> None:
        if envelope.topic.endswith(".AutomationResponse"):
            (command,) = envelope.body.MissionCommandList
            (task,) = {t for w in command.WaypointList for t in w.AssociatedTasks}
            seen.append(task)
            if len(seen) in (50, 200):
                rig.said.clear()
                gc.collect()
                # what the compiler of kernels keeps is no part of it
                ours = (str(type(o).__module__).startswith("cratous.") for o in gc.get_objects())
                alive[len(seen)] = sum(ours)

    rig.bus._taps[:] = [watch]  # a listener that keeps nothing
    for task in order:
        rig.bus.publish(request(task), "test")
    rig.bus.run()
    assert before == 1
    assert seen == order, "each once, in the order in which they came"
    assert alive[200] < alive[50] + 50, "memory is flat"
    assert rig.bus.state(NAME).asked == {}
    assert rig.bus.state("RouteAggregatorService").collecting == {}
    assert rig.bus.state("PlanBuilderService").work == {}
    assert rig.bus.state("AssignmentTreeBranchBoundService") == {}


def test_requests_are_planned_whatever_their_ids(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), must_fly(5))
    asked = [
        lmcp.new("TaskAutomationRequest", RequestID=number, OriginalRequest=request(5))
        for number in (90, 40, -3, 90)
    ]
    rig.tell(*asked)
    answers = rig.got("TaskAutomationResponse")
    assert [a.ResponseID for a in answers] == [90, 40, -3, 90]
    assert all(a.OriginalResponse.MissionCommandList for a in answers)
    assert [u.RequestID for u in rig.got("UniqueAutomationRequest")] == [90, 40, -3, 1]


def test_a_watch_of_what_stands_still_is_planned_and_of_what_is_as_fast_refused(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    watch = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=2)
    still = lmcp.new("GroundVehicleState", ID=2, Location=place(0.02).copy(Altitude=0.0))
    rig.tell(*vehicle(1), still, watch, request(5))
    (command,) = rig.got("AutomationResponse")[0].MissionCommandList
    assert {t for w in command.WaypointList for t in w.AssociatedTasks} == {5}
    rig.tell(still.copy(Groundspeed=30.0), request(5))
    assert not rig.got("AutomationResponse")[1].MissionCommandList
    said = "entity 2 moves at 30.0 m/s, and it flies 30 m/s"
    assert any(said in text for text in rig.reasons("Warning")), rig.reasons("Warning")
