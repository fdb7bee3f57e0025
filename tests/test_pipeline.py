"""The pipeline's services, each alone with the test as its neighbours, and apart in two processes."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import PIPELINE, Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.spec import algebra, algebra_meaning

AGGREGATOR, PLANNER = "RouteAggregatorService", "RoutePlannerVisibilityService"
ASSIGNMENT, BUILDER = "AssignmentTreeBranchBoundService", "PlanBuilderService"
TASKS = "Task services"


def unique(number: int, *tasks: int, vehicles: tuple[int, ...] = (1,), **more: Any) -> Any:
    original = request(*tasks, vehicles=vehicles, **more)
    return lmcp.new("UniqueAutomationRequest", RequestID=number, OriginalRequest=original)


def option(task: int, number: int, *vehicles: int, latitude: float = 0.02, cost: int = 1000) -> Any:
    return lmcp.new(
        "TaskOption",
        TaskID=task,
        OptionID=number,
        EligibleEntities=list(vehicles),
        Cost=cost,
        StartLocation=place(latitude),
        EndLocation=place(latitude + 0.002),
    )


def options(number: int, task: int, *made: Any, composition: str = "") -> Any:
    text = composition or "+(" + " ".join(f"p{o.OptionID}" for o in made) + ")"
    return lmcp.new(
        "TaskPlanOptions",
        CorrespondingAutomationRequestID=number,
        TaskID=task,
        Composition=text if made or composition else "",
        Options=list(made),
    )


def planned(asked: Any, cost: int = 7, missing: tuple[int, ...] = ()) -> Any:
    """A planner's answer to a RoutePlanRequest: `cost` for each, none for some."""
    plans = [
        lmcp.new("RoutePlan", RouteID=c.RouteID, RouteCost=-1 if c.RouteID in missing else cost)
        for c in asked.RouteRequests
    ]
    return lmcp.new(
        "RoutePlanResponse",
        ResponseID=asked.RequestID,
        VehicleID=asked.VehicleID,
        RouteResponses=plans,
    )


def ended(number: int) -> Any:
    """An error that ends a request."""
    info = [lmcp.new("KeyValuePair", Key="RequestID", Value=str(number))]
    return lmcp.new("ServiceStatus", StatusType="Error", Info=info)


# --- aggregator and collector -------------------------------------------------------------------


@pytest.fixture
def collector(tmp_path: Path) -> Rig:
    rig = Rig(tmp_path, AGGREGATOR)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), must_fly(5), must_fly(6))
    return rig


@pytest.mark.shows(
    AGGREGATOR,
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "RoutePlanRequest",
    "RoutePlanResponse",
    "AssignmentCostMatrix",
    "UniqueAutomationResponse",
    "ServiceStatus",
    "EntityState",
)
def test_a_complete_matrix_is_handed_over_once_whatever_the_order(collector: Rig) -> None:
    collector.tell(unique(3, 5, 6, vehicles=(1, 2)))
    collector.tell(options(3, 5, option(5, 1, 1), option(5, 2, 2)))
    collector.tell(options(9, 6, option(6, 1, 1)))  # of another request
    assert not collector.got("RoutePlanRequest")
    collector.tell(options(3, 6, option(6, 1, 1, 2)))
    first, second = collector.got("RoutePlanRequest")
    assert [first.VehicleID, second.VehicleID] == [1, 2]
    assert first.IsCostOnlyRequest
    # from the start to each option, and from one task's option to the other's
    assert len(first.RouteRequests) == 4
    collector.tell(planned(second, 20), planned(second, 99))
    assert not collector.got("AssignmentCostMatrix")
    stray = planned(first, 50)
    stray.ResponseID = 2**40
    collector.tell(stray)
    collector.tell(planned(first, 10, missing=(1,)), planned(first, 98))
    (matrix,) = collector.got("AssignmentCostMatrix")
    assert matrix.TaskList == [5, 6]
    costs = {
        (r.VehicleID, r.IntialTaskID, r.IntialTaskOption, r.DestinationTaskID): r.TimeToGo
        for r in matrix.CostMatrix
    }
    assert costs == {
        (1, 0, 0, 5): 10,
        (1, 5, 1, 6): 10,
        (1, 6, 1, 5): 10,
        (2, 0, 0, 5): 20,
        (2, 0, 0, 6): 20,
        (2, 5, 2, 6): 20,
        (2, 6, 1, 5): 20,
    }
    # a new request has ids of its own, and an ended one is forgotten
    collector.tell(unique(4, 5), options(4, 5, option(5, 1, 1)))
    third = collector.got("RoutePlanRequest")[2]
    assert third.RequestID not in (first.RequestID, second.RequestID)
    collector.tell(lmcp.new("UniqueAutomationResponse", ResponseID=4), planned(third))
    collector.tell(unique(5, 5), options(5, 5, option(5, 1, 1)))
    fourth = collector.got("RoutePlanRequest")[3]
    collector.tell(ended(5), planned(fourth))
    assert len(collector.got("AssignmentCostMatrix")) == 1


def test_without_any_option_the_matrix_is_empty_and_comes_at_once(collector: Rig) -> None:
    collector.tell(unique(1, 5), options(1, 5))
    (matrix,) = collector.got("AssignmentCostMatrix")
    assert matrix.CostMatrix == []


@pytest.mark.shows(AGGREGATOR, "RouteRequest", "RouteResponse", "EntityConfiguration")
def test_route_requests_are_split_by_vehicle_and_answered_when_complete(collector: Rig) -> None:
    way = lmcp.new("RouteConstraints", RouteID=1, StartLocation=place(0), EndLocation=place(0.1))
    asked = lmcp.new("RouteRequest", RequestID=70, AssociatedTaskID=5, RouteRequests=[way])
    collector.tell(asked, asked.copy(RequestID=71, VehicleID=[2]))  # no vehicle named: all
    one, two, three = collector.got("RoutePlanRequest")
    assert [one.VehicleID, two.VehicleID, three.VehicleID] == [1, 2, 2]
    assert one.AssociatedTaskID == 5
    collector.tell(planned(two, 2), planned(three, 3))
    (answer,) = collector.got("RouteResponse")
    assert (answer.ResponseID, answer.Routes[0].RouteResponses[0].RouteCost) == (71, 3)
    collector.tell(planned(one, 1))
    answer = collector.got("RouteResponse")[1]
    assert answer.ResponseID == 70
    assert [r.RouteResponses[0].RouteCost for r in answer.Routes] == [1, 2]


# --- routes --------------------------------------------------------------------------------------


@pytest.mark.shows(
    PLANNER,
    "RoutePlanRequest",
    "RoutePlanResponse",
    "EntityConfiguration",
    "EntityState",
    "KeepInZone",
    "KeepOutZone",
    "OperatingRegion",
)
def test_any_route_of_a_known_vehicle_is_answered_and_keeps_out_of_zones(tmp_path: Path) -> None:
    rig = Rig(tmp_path, PLANNER)
    box = lmcp.new("Rectangle", CenterPoint=place(0.02), Width=800.0, Height=800.0)
    rig.tell(
        *vehicle(1),
        lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box),
        lmcp.new("OperatingRegion", ID=3, KeepOutAreas=[8]),
        lmcp.new(
            "KeepInZone",
            ZoneID=9,
            MaxAltitude=9000.0,
            Boundary=lmcp.new("Rectangle", CenterPoint=place(0), Width=4000.0, Height=4000.0),
        ),
        lmcp.new("OperatingRegion", ID=4, KeepInAreas=[9]),
    )
    way = lmcp.new("RouteConstraints", RouteID=4, StartLocation=place(0), EndLocation=place(0.04))
    inside = way.copy(RouteID=5, EndLocation=place(0.02))
    asked = lmcp.new(
        "RoutePlanRequest", RequestID=9, VehicleID=1, RouteRequests=[way], IsCostOnlyRequest=False
    )
    rig.tell(asked, asked.copy(OperatingRegion=3, RouteRequests=[way, inside]))
    free, bound = rig.got("RoutePlanResponse")
    assert (free.ResponseID, free.VehicleID) == (9, 1)
    straight_ms = free.RouteResponses[0].RouteCost
    assert straight_ms == pytest.approx(0.04 * 110_574 / 20 * 1000, rel=1e-3)
    around, none = bound.RouteResponses
    assert around.RouteCost > straight_ms + 5000
    assert max(abs(w.Longitude) for w in around.Waypoints) > 400 / 111_320
    assert none.RouteCost == -1
    assert "zone 8" in none.RouteError[0].Value
    rig.tell(asked.copy(VehicleID=77), asked.copy(OperatingRegion=6))
    for answer, words in zip(
        rig.got("RoutePlanResponse")[2:], ("vehicle 77", "region 6"), strict=True
    ):
        assert answer.RouteResponses[0].RouteCost == -1
        assert words in answer.RouteResponses[0].RouteError[0].Value
    rig.tell(asked.copy(OperatingRegion=4))  # its end lies outside
    assert "zone 9" in rig.got("RoutePlanResponse")[-1].RouteResponses[0].RouteError[0].Value
    # a heading that is not asked for costs no turn
    west = asked.copy(RouteRequests=[way.copy(StartHeading=270.0), way.copy(
        StartHeading=270.0, UseStartHeading=False)])  # fmt: skip
    rig.tell(west)
    turned, free_heading = rig.got("RoutePlanResponse")[-1].RouteResponses
    assert turned.RouteCost > free_heading.RouteCost + 1000
    assert free_heading.RouteCost == pytest.approx(straight_ms, abs=2)


# --- assignment ----------------------------------------------------------------------------------


def cost(
    vehicle_id: int, task: int, number: int, time: int, start: tuple[int, int] = (0, 0)
) -> Any:
    return lmcp.new(
        "TaskOptionCost",
        VehicleID=vehicle_id,
        IntialTaskID=start[0],
        IntialTaskOption=start[1],
        DestinationTaskID=task,
        DestinationTaskOption=number,
        TimeToGo=time,
    )


def matrix(number: int, *rows: Any) -> Any:
    return lmcp.new(
        "AssignmentCostMatrix", CorrespondingAutomationRequestID=number, CostMatrix=list(rows)
    )


@pytest.fixture
def assigner(tmp_path: Path) -> Rig:
    rig = Rig(tmp_path, ASSIGNMENT)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), must_fly(5), must_fly(6))
    return rig


@pytest.mark.shows(
    ASSIGNMENT,
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "AssignmentCostMatrix",
    "TaskAssignmentSummary",
)
def test_options_and_costs_of_messages_alone_decide(assigner: Rig) -> None:
    """Options that no service of this process has computed, as another's tasks may send them."""
    assigner.tell(
        unique(2, 5, 6, vehicles=(1, 2)),
        options(2, 5, option(5, 31, 1, cost=10_000), option(5, 32, 2, cost=20_000)),
        options(2, 6, option(6, 1, 1, 2, cost=5_000)),
        matrix(
            2,
            cost(1, 5, 31, 1_000),
            cost(2, 5, 32, 1_000),
            cost(1, 6, 1, 50_000),
            cost(2, 6, 1, 2_000),
            cost(1, 6, 1, 50_000, (5, 31)),
        ),
    )
    (summary,) = assigner.got("TaskAssignmentSummary")
    made = {
        t.TaskID: (t.AssignedVehicle, t.OptionID, t.TimeTaskCompleted) for t in summary.TaskList
    }
    assert made == {5: (1, 31, 11_000), 6: (2, 1, 7_000)}


def test_ineligible_and_excluded_vehicles_get_nothing_whatever_rows_there_are(
    assigner: Rig,
) -> None:
    assigner.tell(
        unique(2, 5, vehicles=(1,)),
        options(2, 5, option(5, 1, 1, cost=9_000)),
        matrix(2, cost(1, 5, 1, 90_000), cost(2, 5, 1, 1)),  # vehicle 2 is not in the request
    )
    (summary,) = assigner.got("TaskAssignmentSummary")
    assert [t.AssignedVehicle for t in summary.TaskList] == [1]
    assert "take no part" in assigner.reasons("Warning")[0]
    assigner.tell(
        unique(3, 5, vehicles=(1, 2)),
        options(3, 5, option(5, 1, 1, cost=9_000)),
        matrix(3, cost(1, 5, 1, 90_000), cost(2, 5, 1, 1)),  # vehicle 2 is not eligible
    )
    assert [t.AssignedVehicle for t in assigner.got("TaskAssignmentSummary")[1].TaskList] == [1]


@pytest.mark.parametrize(
    ("told", "rows", "words"),
    [
        (options(2, 5, option(5, 1, 1), composition="+(p1 p9)"), [], "no choice of the options"),
        (
            options(2, 5, option(5, 1, 1), option(5, 2, 1), composition=".(p1 p2)"),
            [],
            "not covered",
        ),
        (
            options(2, 5, option(5, 1, 1), composition="+(1)"),
            [],
            "Composition|composition|expected",
        ),
        (options(2, 5, option(5, 1, 1), composition="p1 |(p1"), [], "expected"),
        (options(2, 5, option(5, 1, 1)), [cost(1, 5, 8, 1)], "no such way between options"),
        (options(2, 5, option(5, 1, 1)), [cost(1, 5, 1, -4)], "no time below 0"),
        (options(2, 5, option(5, 1, 1, cost=-1)), [cost(1, 5, 1, 4)], "Cost of 0 ms or more"),
        (options(2, 5, option(5, 1, 1)), [], "the costs have no way to task 5"),
        (options(2, 5), [], "task 5"),
    ],
)
@pytest.mark.shows(ASSIGNMENT, "ServiceStatus")
def test_what_cannot_be_assigned_is_answered_with_the_reason(
    assigner: Rig, told: Any, rows: list[Any], words: str
) -> None:
    import re

    assigner.tell(unique(2, 5), told, matrix(2, *rows))
    assert not assigner.got("TaskAssignmentSummary")
    errors = [b for b in assigner.got("ServiceStatus") if b.StatusType.name == "Error"]
    (error,) = errors
    facts = {pair.Key: pair.Value for pair in error.Info}
    assert facts["RequestID"] == "2"
    assert re.search(words, " ".join(assigner.reasons())), assigner.reasons()
    assert not assigner.said.has("fails at")


@pytest.mark.shows(ASSIGNMENT, "CostFunction")
@pytest.mark.parametrize(
    ("function", "made"), [("MINMAX", {5: 1, 6: 2}), ("CUMULATIVE", {5: 1, 6: 1})]
)
def test_the_cost_function_decides(tmp_path: Path, function: str, made: dict[int, int]) -> None:
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: f'CostFunction="{function}"'})
    rig.tell(
        *vehicle(1),
        *vehicle(2, 0.01),
        must_fly(5),
        must_fly(6),
        unique(2, 5, 6, vehicles=(1, 2)),
        options(2, 5, option(5, 1, 1, cost=10_000)),
        options(2, 6, option(6, 1, 1, 2, cost=10_000)),
        matrix(
            2,
            cost(1, 5, 1, 1_000),
            cost(1, 6, 1, 1_000, (5, 1)),
            cost(1, 6, 1, 90_000),
            cost(2, 6, 1, 8_000),
        ),
    )
    (summary,) = rig.got("TaskAssignmentSummary")
    assert {t.TaskID: t.AssignedVehicle for t in summary.TaskList} == made


@pytest.mark.shows(ASSIGNMENT, "Semantics")
@pytest.mark.parametrize(("semantics", "waits"), [("time", True), ("order", False)])
def test_the_semantics_decide_whether_a_dot_is_about_time(
    tmp_path: Path, semantics: str, waits: bool
) -> None:
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: f'Semantics="{semantics}"'})
    rig.tell(
        *vehicle(1),
        *vehicle(2, 0.01),
        must_fly(5),
        must_fly(6),
        unique(2, 5, 6, vehicles=(1, 2), TaskRelationships=".(p5 p6)"),
        options(2, 5, option(5, 1, 1)),
        options(2, 6, option(6, 1, 2)),
        matrix(2, cost(1, 5, 1, 500_000), cost(2, 6, 1, 1_000)),
    )
    (summary,) = rig.got("TaskAssignmentSummary")
    ended = {t.TaskID: t.TimeTaskCompleted for t in summary.TaskList}
    assert (ended[6] > ended[5]) is waits


FIRST_PLAN_NODES = 80


@pytest.mark.shows(ASSIGNMENT, "NumberNodesMaximum", "Deadline_ms")
@pytest.mark.parametrize(
    ("limit", "most"),
    [('NumberNodesMaximum="3"', 3), ('Deadline_ms="1"', 100), ('NumberNodesMaximum="-1"', None)],
)
def test_the_search_keeps_its_limit(tmp_path: Path, limit: str, most: int | None) -> None:
    """Beyond the first plan, which is made in any case, and one round that improves it."""
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: limit})
    rng, tasks = random.Random(4), range(5, 13)
    rows = [
        cost(v, task, 1, rng.randrange(1_000, 90_000), start)
        for v in (1, 2)
        for task in tasks
        for start in [(0, 0), *((other, 1) for other in tasks if other != task)]
    ]
    rig.tell(*vehicle(1), *vehicle(2, 0.01), *map(must_fly, tasks))
    rig.tell(unique(2, *tasks, vehicles=(1, 2)))
    rig.tell(*(options(2, task, option(task, 1, 1, 2)) for task in tasks), matrix(2, *rows))
    assert len(rig.got("TaskAssignmentSummary")) == 1
    told = [{p.Key: p.Value for p in body.Info} for body in rig.got("ServiceStatus")]
    (facts,) = [found for found in told if "nodes" in found]
    assert facts["status"] == ("optimal" if most is None else "feasible")
    assert most is None or int(facts["nodes"]) <= most + FIRST_PLAN_NODES


@pytest.mark.shows(ASSIGNMENT, "UniqueAutomationResponse", "ServiceStatus")
def test_a_request_that_has_ended_is_not_assigned_any_more(assigner: Rig) -> None:
    for number, end in ((2, lmcp.new("UniqueAutomationResponse", ResponseID=2)), (3, ended(3))):
        assigner.tell(unique(number, 5), options(number, 5, option(5, 1, 1)), end)
        assigner.tell(matrix(number, cost(1, 5, 1, 4)))
    assert not assigner.got("TaskAssignmentSummary")


def test_what_the_original_was_asked_is_answered_once_each(shared: Path, tmp_path: Path) -> None:
    """Relations and compositions that the original crashes at, ignores or misreads."""
    cases = json.loads((shared / "vectors/openuxas/algebra/service_cases.json").read_text())
    rig = Rig(tmp_path, ASSIGNMENT)
    rig.tell(*vehicle(1), *[must_fly(n, 0.02 + 0.01 * n) for n in (1, 2, 3)])
    rows = [cost(1, n, 1, 1_000) for n in (1, 2, 3)]
    rows += [cost(1, b, 1, 1_000, (a, 1)) for a in (1, 2, 3) for b in (1, 2, 3) if a != b]
    assert len(cases) > 30
    for number, case in enumerate(cases, 1):
        rig.all.clear()
        text, compositions = case["TaskRelationships"], case["Compositions"]
        rig.tell(unique(number, 1, 2, 3, TaskRelationships=text))
        for task, composition in compositions.items():
            told = options(number, int(task), option(int(task), 1, 1), composition="x")
            rig.tell(told.copy(Composition=composition))
        rig.tell(matrix(number, *rows))
        summaries, errors = rig.got("TaskAssignmentSummary"), rig.reasons()
        assert len(summaries) + bool(errors) == 1, (text, compositions, errors)
        if not summaries:
            assert all(errors), case["label"]
            continue
        # what is assigned is what the text means
        assigned = tuple(t.TaskID for t in summaries[0].TaskList)
        term = algebra.parse(text, frozenset((1, 2, 3))) if text.strip() else None
        if term is not None:
            meant = {frozenset(algebra_meaning.tasks(b)) for b in algebra_meaning.branches(term)}
            assert frozenset(assigned) in meant, case["label"]
        else:
            assert set(assigned) == {1, 2, 3}
        assert len(set(assigned)) == len(assigned)
    assert not rig.said.has("fails at")


def test_large_option_ids_are_kept_apart(assigner: Rig) -> None:
    assigner.tell(
        unique(2, 5, 6),
        options(2, 5, option(5, 100_006, 1), option(5, 200_001, 1)),
        options(2, 6, option(6, 6, 1)),
        matrix(
            2,
            cost(1, 5, 100_006, 9_000),
            cost(1, 5, 200_001, 1_000),
            cost(1, 6, 6, 90_000),
            cost(1, 6, 6, 1_000, (5, 200_001)),
            cost(1, 6, 6, 2_000, (5, 100_006)),
        ),
    )
    (made,) = assigner.got("TaskAssignmentSummary")
    assert [(t.TaskID, t.OptionID) for t in made.TaskList] == [(5, 200_001), (6, 6)]


def test_requests_that_never_end_do_not_pile_up(tmp_path: Path) -> None:
    rig = Rig(tmp_path, AGGREGATOR, ASSIGNMENT, BUILDER)
    rig.tell(*vehicle(1), must_fly(5))
    way = lmcp.new("RouteConstraints", StartLocation=place(0), EndLocation=place(0.1))
    for number in range(1, 200):
        rig.tell(unique(number, 5), options(number, 5, option(5, 1, 1)))
        rig.tell(lmcp.new("RouteRequest", RequestID=number, RouteRequests=[way]))
    assert len(rig.bus.state(AGGREGATOR).collecting) <= 16
    assert len(rig.bus.state(AGGREGATOR).routes) <= 64
    assert len(rig.bus.state(ASSIGNMENT)) <= 16
    assert len(rig.bus.state(BUILDER).work) <= 16


def test_a_matrix_before_the_options_is_named(assigner: Rig) -> None:
    assigner.tell(unique(2, 5, 6), options(2, 5, option(5, 1, 1)), matrix(2, cost(1, 5, 1, 4)))
    assert any("TaskPlanOptions of task 6" in text for text in assigner.reasons())


# --- builder -------------------------------------------------------------------------------------


def summary(number: int, *assigned: tuple[int, int]) -> Any:
    return lmcp.new(
        "TaskAssignmentSummary",
        CorrespondingAutomationRequestID=number,
        TaskList=[
            lmcp.new("TaskAssignment", TaskID=t, OptionID=1, AssignedVehicle=v) for t, v in assigned
        ],
    )


def implemented(asked: Any, *waypoints: int, latitude: float = 0.5) -> Any:
    points = [
        lmcp.new("Waypoint", Number=n, NextWaypoint=n + 1, AssociatedTasks=[asked.TaskID])
        for n in waypoints
    ]
    return lmcp.new(
        "TaskImplementationResponse",
        ResponseID=asked.RequestID,
        CorrespondingAutomationRequestID=asked.CorrespondingAutomationRequestID,
        TaskID=asked.TaskID,
        VehicleID=asked.VehicleID,
        TaskWaypoints=points,
        FinalLocation=place(latitude),
        FinalHeading=45.0,
        FinalTime=9_000,
    )


@pytest.mark.shows(
    BUILDER,
    "UniqueAutomationRequest",
    "TaskAssignmentSummary",
    "TaskImplementationRequest",
    "TaskImplementationResponse",
    "UniqueAutomationResponse",
    "EntityState",
)
def test_tasks_are_implemented_in_assignment_order_and_answered_once(tmp_path: Path) -> None:
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), unique(4, 5, 6, 7, vehicles=(1, 2)))
    rig.tell(summary(4, (5, 1), (6, 2), (7, 1)))
    (first,) = rig.got("TaskImplementationRequest")
    assert (first.TaskID, first.VehicleID, first.StartPosition) == (5, 1, place(0.0))
    ahead = first.copy(TaskID=7)
    rig.tell(implemented(ahead, 1))  # not its turn
    assert len(rig.got("TaskImplementationRequest")) == 1
    assert "out of turn" in rig.reasons("Warning")[0]
    rig.tell(implemented(first, 1, 2), implemented(first, 1, 2))
    second = rig.got("TaskImplementationRequest")[1]
    assert (second.TaskID, second.VehicleID) == (6, 2)
    assert len(rig.got("TaskImplementationRequest")) == 2
    rig.tell(implemented(second, 1))
    third = rig.got("TaskImplementationRequest")[2]
    # from where and when the vehicle's task before ends, numbered on
    assert (third.StartPosition, third.StartHeading, third.StartTime) == (place(0.5), 45.0, 9_000)
    assert third.StartingWaypointID == 3
    assert not rig.got("UniqueAutomationResponse")
    rig.tell(implemented(third, 3, 4), implemented(third, 3, 4), summary(4, (5, 1)))
    (response,) = rig.got("UniqueAutomationResponse")
    assert response.ResponseID == 4
    one, two = response.OriginalResponse.MissionCommandList
    assert [w.Number for w in one.WaypointList] == [1, 2, 3, 4]
    assert one.WaypointList[-1].NextWaypoint == 4
    assert [w.Number for w in two.WaypointList] == [1]
    assert [s.EntityID for s in response.FinalStates] == [1, 2]
    assert rig.bus.state(BUILDER).work == {}


@pytest.mark.shows(BUILDER, "ServiceStatus")
def test_an_empty_assignment_or_implementation_is_answered_with_an_error(tmp_path: Path) -> None:
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*vehicle(1), unique(4, 5), summary(4), unique(6, 5), summary(6, (5, 1)))
    (asked,) = rig.got("TaskImplementationRequest")
    rig.tell(implemented(asked), summary(77, (5, 1)))
    assert rig.reasons() == [
        "the assignment has no task",
        "task 5 was implemented without waypoints or end",
    ]
    assert "TaskAssignmentSummary of a request that is not" in rig.reasons("Warning")[0]
    rig.tell(unique(8, 5), ended(8), summary(8, (5, 1)))
    assert len(rig.got("TaskImplementationRequest")) == 1
    assert not rig.got("UniqueAutomationResponse")


@pytest.mark.shows(BUILDER, "AddLoiterToEndOfMission", "DefaultLoiterRadius_m", "TurnType")
def test_the_end_is_loitered_at_and_turns_are_flown_over_if_asked(tmp_path: Path) -> None:
    text = 'AddLoiterToEndOfMission="TRUE" DefaultLoiterRadius_m="250" TurnType="FlyOver"'
    rig = Rig(tmp_path, BUILDER, **{BUILDER: text})
    rig.tell(*vehicle(1), unique(4, 5), summary(4, (5, 1)))
    rig.tell(implemented(rig.got("TaskImplementationRequest")[0], 1, 2))
    (command,) = rig.got("UniqueAutomationResponse")[0].OriginalResponse.MissionCommandList
    assert {w.TurnType.name for w in command.WaypointList} == {"FlyOver"}
    assert [len(w.VehicleActionList) for w in command.WaypointList] == [0, 1]
    loiter_action = command.WaypointList[-1].VehicleActionList[0]
    assert (loiter_action.Radius, loiter_action.Duration) == (250.0, -1)


# --- tasks ---------------------------------------------------------------------------------------


@pytest.mark.shows(
    "TaskManagerService",
    "Task",
    "RemoveTasks",
    "CreateNewService",
    "KillService",
    "EntityState",
    "EntityConfiguration",
)
@pytest.mark.shows(TASKS, "TaskInitialized")
def test_a_task_has_a_service_until_it_is_removed(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), must_fly(5))
    (made,) = rig.got("CreateNewService")
    assert [s.ID for s in made.EntityStates] == [1]
    assert [c.ID for c in made.EntityConfigurations] == [1]
    assert [b.TaskID for b in rig.got("TaskInitialized")] == [5]
    rig.tell(must_fly(5, 0.03))
    assert [b.ServiceID for b in rig.got("KillService")] == [made.ServiceID]
    assert [n for n in rig.bus.names() if "[5]" in n] == ["MustFlyTaskService[5]"]
    rig.tell(lmcp.new("RemoveTasks", TaskList=[5, 9]))
    assert not [n for n in rig.bus.names() if "[5]" in n]


def flying(number: int, *tasks: int, time: int = 0) -> Any:
    return vehicle(number)[1].copy(AssociatedTasks=list(tasks), Time=time)


@pytest.mark.shows(TASKS, "EntityState", "TaskActive", "TaskComplete")
def test_a_task_is_active_while_a_vehicle_says_so_and_completes_after(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *vehicle(2, 0.01), loiter(5), request(5))
    assert rig.got("AutomationResponse")[0].MissionCommandList
    rig.tell(flying(2, 5, time=10), flying(1, time=20))
    assert not rig.got("TaskActive")  # another vehicle, and not yet
    rig.tell(flying(1, 5, time=30), flying(1, 5, time=40))
    assert [(b.EntityID, b.TimeTaskActivated) for b in rig.got("TaskActive")] == [(1, 30)]
    rig.tell(flying(1, time=50), flying(1, time=60))
    (done,) = rig.got("TaskComplete")
    assert (done.TaskID, done.EntitiesInvolved, done.TimeTaskCompleted) == (5, [1], 50)
    rig.tell(request(5))
    assert rig.got("AutomationResponse")[1].MissionCommandList


@pytest.mark.shows(TASKS, "AutomationResponse", "ServiceStatus")
def test_a_task_whose_plan_is_withdrawn_says_that_it_ends_undone(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), loiter(5), loiter(6, 0.03), request(5))
    rig.tell(flying(1, 5), request(6))
    assert not rig.got("TaskComplete")
    assert rig.reasons("Warning") == ["task 5 ends undone: its plan was withdrawn or overridden"]
    rig.tell(request(5))
    assert len(rig.got("AutomationResponse")[2].MissionCommandList) == 1


def test_an_active_task_that_is_asked_again_ends_and_answers_the_new_request(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), loiter(5), request(5))
    rig.tell(flying(1, 5))
    rig.tell(request(5))
    assert [len(b.MissionCommandList) for b in rig.got("AutomationResponse")] == [1, 1]
    assert rig.reasons("Warning") == ["task 5 ends undone: its plan was withdrawn or overridden"]


@pytest.mark.shows(
    TASKS,
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "TaskImplementationRequest",
    "RoutePlanRequest",
    "RoutePlanResponse",
    "TaskImplementationResponse",
)
def test_a_task_answers_only_its_own_request_and_options(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService", "AutomationRequestValidatorService")
    rig.tell(*vehicle(1), loiter(5), request(5))
    (offered,) = rig.got("TaskPlanOptions")
    numbers = [o.OptionID for o in offered.Options]
    assert offered.Composition == "+(" + " ".join(f"p{n}" for n in numbers) + ")"
    asked = lmcp.new(
        "TaskImplementationRequest",
        RequestID=1,
        CorrespondingAutomationRequestID=9,
        VehicleID=1,
        TaskID=5,
        OptionID=numbers[0],
        StartPosition=place(0.0),
    )
    rig.tell(asked)
    assert not rig.got("RoutePlanRequest")
    mine = asked.copy(CorrespondingAutomationRequestID=1)
    rig.tell(mine)
    (route,) = rig.got("RoutePlanRequest")
    first = next(o for o in offered.Options if o.OptionID == numbers[0])
    assert route.RouteRequests[0].EndLocation == first.StartLocation
    points = [lmcp.new("Waypoint", Number=n, Latitude=0.001 * n) for n in (1, 2)]
    plan = lmcp.new("RoutePlan", RouteID=1, RouteCost=5_000, Waypoints=points)
    answer = planned(route).copy(AssociatedTaskID=5, RouteResponses=[plan])
    rig.tell(answer.copy(ResponseID=route.RequestID + 1))
    assert not rig.got("TaskImplementationResponse")
    rig.tell(answer)
    (made,) = rig.got("TaskImplementationResponse")
    assert (made.TaskID, made.VehicleID, made.FinalTime) == (5, 1, 5_000 + first.Cost)
    assert made.FinalLocation == first.EndLocation
    assert [w.Number for w in made.TaskWaypoints] == list(range(len(made.TaskWaypoints)))


@pytest.mark.shows(TASKS, "UniqueAutomationResponse", "ServiceStatus")
@pytest.mark.parametrize("end", ["response", "error"])
def test_a_task_lets_a_request_go_that_has_ended(tmp_path: Path, end: str) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), loiter(5))
    rig.tell(unique(1, 5))
    (offered,) = rig.got("TaskPlanOptions")
    asked = lmcp.new(
        "TaskImplementationRequest",
        CorrespondingAutomationRequestID=1,
        VehicleID=1,
        TaskID=5,
        OptionID=offered.Options[0].OptionID,
        StartPosition=place(0.0),
    )
    ending = lmcp.new("UniqueAutomationResponse", ResponseID=1) if end == "response" else ended(1)
    rig.tell(ending, asked)
    assert not rig.got("RoutePlanRequest")
    rig.tell(unique(2, 5), asked.copy(CorrespondingAutomationRequestID=2, OptionID=999))
    assert len(rig.got("TaskPlanOptions")) == 2
    assert not rig.got("RoutePlanRequest")
    assert "task 5 has no such option" in rig.reasons()[0]


def test_a_route_that_is_not_there_is_an_error_with_its_reason(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskManagerService")
    rig.tell(*vehicle(1), loiter(5))
    rig.tell(unique(1, 5))
    asked = lmcp.new(
        "TaskImplementationRequest",
        CorrespondingAutomationRequestID=1,
        VehicleID=1,
        TaskID=5,
        OptionID=1,
        StartPosition=place(0.0),
    )
    rig.tell(asked)
    (route,) = rig.got("RoutePlanRequest")
    why = [lmcp.new("KeyValuePair", Key="reason", Value="a wall")]
    plan = lmcp.new("RoutePlan", RouteID=1, RouteCost=-1, RouteError=why)
    rig.tell(planned(route).copy(AssociatedTaskID=5, RouteResponses=[plan]))
    assert rig.reasons() == ["vehicle 1 has no way to task 5: a wall"]
    assert not rig.got("TaskImplementationResponse")


# --- apart ---------------------------------------------------------------------------------------


def joined(one: Rig, other: Rig) -> None:
    """What one publishes the other gets as bytes, as over a bridge, and the other way round."""

    def to(target: Rig, foreign: str) -> Any:
        def pass_on(envelope: Envelope) -> None:
            quiet = envelope.topic.endswith(("CreateNewService", "KillService"))
            if envelope.source != foreign and not quiet:
                body = lmcp.binary.unpack(lmcp.binary.pack(envelope.body))
                target.bus.publish(body, "afar")

        return pass_on

    one.bus.tap(to(other, "afar"))
    other.bus.tap(to(one, "afar"))


@pytest.mark.parametrize("here", [PIPELINE[:2], PIPELINE[1:4], PIPELINE[:1] + PIPELINE[3:5]])
def test_services_in_two_processes_plan_as_in_one(tmp_path: Path, here: tuple[str, ...]) -> None:
    """Any of them may be elsewhere: they share nothing but messages."""
    folders = [tmp_path / name for name in "abc"]
    for folder in folders:
        folder.mkdir()
    whole = Rig(folders[0])
    one, other = Rig(folders[1], *here), Rig(folders[2], *[n for n in PIPELINE if n not in here])
    joined(one, other)
    bodies = [
        *vehicle(1),
        *vehicle(2, 0.01),
        loiter(5),
        must_fly(6, 0.03, 0.01),
        request(5, 6, vehicles=(1, 2), TaskRelationships=".(p5 p6)"),
    ]
    whole.tell(*bodies)
    one.tell(*bodies)
    while other.bus.run() or one.bus.run():
        pass
    (alone,), (apart,) = whole.got("AutomationResponse"), one.got("AutomationResponse")
    assert not one.reasons()
    plans = [
        [
            (c.VehicleID, len(c.WaypointList), c.WaypointList[-1].AssociatedTasks)
            for c in body.MissionCommandList
        ]
        for body in (alone, apart)
    ]
    assert plans[0] == plans[1]
    ends = [
        [
            (t.TaskID, t.OptionID, t.AssignedVehicle)
            for t in r.got("TaskAssignmentSummary")[0].TaskList
        ]
        for r in (whole, one)
    ]
    assert ends[0] == ends[1]
    for a, b in zip(alone.MissionCommandList, apart.MissionCommandList, strict=True):
        for p, q in zip(a.WaypointList, b.WaypointList, strict=True):
            assert p.Latitude == pytest.approx(q.Latitude, abs=1e-8)
