"""Our services in place of the original's, one by one: its recorded messages in, its messages out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig

from cratous.bridge import envelope, lmcp, sentinel

AGGREGATOR, PLANNER = "RouteAggregatorService", "RoutePlannerVisibilityService"
ASSIGNMENT, BUILDER = "AssignmentTreeBranchBoundService", "PlanBuilderService"
VALIDATOR, MANAGER = "AutomationRequestValidatorService", "WaypointPlanManagerService"
TURN_MS = 60_000
"""A full turn of the faster vehicle takes less [ms]."""


@pytest.fixture(scope="module")
def recorded(shared: Path) -> list[Any]:
    """All messages of the original's waterway run, in order."""
    data = (shared / "vectors/openuxas/frames/waterway-stream.tcp.bin").read_bytes()
    frames = sentinel.FrameStream().feed(data)
    messages = [envelope.parse(frame) for frame in frames]
    return [(m, lmcp.binary.unpack(m.payload)) for m in messages]


def of(recorded: list[Any], *kinds: str) -> list[Any]:
    return [body for _, body in recorded if type(body).__name__ in kinds]


WORLD = ("AirVehicleConfiguration", "AirVehicleState", "LineSearchTask")


def test_the_validator(recorded: list[Any], tmp_path: Path) -> None:
    rig = Rig(tmp_path, VALIDATOR)
    rig.tell(*of(recorded, *WORLD, "TaskInitialized", "AutomationRequest"))
    (ours,), (theirs,) = rig.got("UniqueAutomationRequest"), of(recorded, "UniqueAutomationRequest")
    assert ours.OriginalRequest == theirs.OriginalRequest
    (response,) = of(recorded, "UniqueAutomationResponse")
    rig.tell(response.copy(ResponseID=ours.RequestID))
    assert rig.got("AutomationResponse") == of(recorded, "AutomationResponse")


def test_aggregator_and_collector(recorded: list[Any], tmp_path: Path) -> None:
    rig = Rig(tmp_path, AGGREGATOR)
    rig.tell(*of(recorded, *WORLD, "UniqueAutomationRequest", "TaskPlanOptions"))
    costs = {}  # what the original's planner says of each way
    for asked in of(recorded, "RoutePlanRequest"):
        ways = {c.RouteID: (str(c.StartLocation), str(c.EndLocation)) for c in asked.RouteRequests}
        for answer in of(recorded, "RoutePlanResponse"):
            for plan in answer.RouteResponses:
                if answer.VehicleID == asked.VehicleID and plan.RouteID in ways:
                    costs[asked.VehicleID, ways[plan.RouteID]] = plan.RouteCost
    for asked in rig.got("RoutePlanRequest"):
        plans = []
        for c in asked.RouteRequests:
            key = asked.VehicleID, (str(c.StartLocation), str(c.EndLocation))
            plans.append(lmcp.new("RoutePlan", RouteID=c.RouteID, RouteCost=costs.get(key, -1)))
        rig.tell(
            lmcp.new(
                "RoutePlanResponse",
                ResponseID=asked.RequestID,
                VehicleID=asked.VehicleID,
                RouteResponses=plans,
            )
        )
    (ours,), (theirs,) = rig.got("AssignmentCostMatrix"), of(recorded, "AssignmentCostMatrix")

    def rows(matrix: Any) -> set[tuple[int, ...]]:
        return {
            (r.VehicleID, r.IntialTaskID, r.DestinationTaskID, r.DestinationTaskOption, r.TimeToGo)
            for r in matrix.CostMatrix
            if r.IntialTaskID == 0
        }

    assert len(rows(ours)) == 4
    assert rows(ours) == {row for row in rows(theirs) if row[2] != 0}


@pytest.mark.shows(PLANNER, "AircraftPathPlanner", "RoutePlanRequest", "RoutePlanResponse")
def test_the_planner(recorded: list[Any], tmp_path: Path) -> None:
    """The original's costs are those of straight ways; ours are flown: at most two turns longer."""
    rig = Rig(tmp_path, PLANNER)
    rig.tell(*of(recorded, *WORLD))
    asked = [(m, b) for m, b in recorded if type(b).__name__ == "RoutePlanRequest"]
    assert {m.address for m, _ in asked} == {"AircraftPathPlanner", asked[-1][1].all_names[0]}
    from cratous.services.bus import Envelope

    for message, body in asked:
        rig.bus.put(Envelope(0, 0, "x", body.all_names[0], body, message.address, "", 100, 55))
    rig.bus.run()
    answers = [e for e in rig.all if e.topic.endswith("RoutePlanResponse")]
    assert {e.address for e in answers} == {"eid100.sid55"}, "to the service that has asked"
    theirs = of(recorded, "RoutePlanResponse")
    assert len(answers) == len(theirs)
    for ours, their in zip((e.body for e in answers), theirs, strict=True):
        assert (ours.ResponseID, ours.VehicleID) == (their.ResponseID, their.VehicleID)
        found = {p.RouteID: p.RouteCost for p in ours.RouteResponses}
        for plan in their.RouteResponses:
            if plan.RouteCost > 0:
                assert 0.99 * plan.RouteCost <= found[plan.RouteID] <= plan.RouteCost + 2 * TURN_MS


def test_the_assignment(recorded: list[Any], tmp_path: Path) -> None:
    rig = Rig(tmp_path, ASSIGNMENT)
    before = ("UniqueAutomationRequest", "TaskPlanOptions", "AssignmentCostMatrix")
    rig.tell(*of(recorded, *WORLD, *before))
    (ours,), (theirs,) = rig.got("TaskAssignmentSummary"), of(recorded, "TaskAssignmentSummary")
    assert ours.CorrespondingAutomationRequestID == theirs.CorrespondingAutomationRequestID
    (mine,), (their,) = ours.TaskList, theirs.TaskList
    names = ("TaskID", "OptionID", "AssignedVehicle", "TimeTaskCompleted")
    assert [getattr(mine, n) for n in names] == [getattr(their, n) for n in names]


def test_the_builder(recorded: list[Any], tmp_path: Path) -> None:
    rig = Rig(tmp_path, BUILDER)
    rig.tell(*of(recorded, *WORLD, "UniqueAutomationRequest", "TaskAssignmentSummary"))
    (asked,), (their,) = (
        rig.got("TaskImplementationRequest"),
        of(recorded, "TaskImplementationRequest"),
    )
    for name in ("RequestID", "StartingWaypointID", "VehicleID", "TaskID", "OptionID", "StartTime"):
        assert getattr(asked, name) == getattr(their, name)
    assert asked.StartPosition.Latitude == pytest.approx(their.StartPosition.Latitude, abs=1e-7)
    rig.tell(*of(recorded, "TaskImplementationResponse"))
    (ours,), (theirs,) = (
        rig.got("UniqueAutomationResponse"),
        of(recorded, "UniqueAutomationResponse"),
    )
    assert ours.ResponseID == theirs.ResponseID
    (mine,), (other,) = (r.OriginalResponse.MissionCommandList for r in (ours, theirs))
    places = [
        [(w.Number, w.Latitude, w.Longitude, w.Altitude) for w in c.WaypointList]
        for c in (mine, other)
    ]
    assert places[0] == places[1]


def test_the_waypoint_manager(recorded: list[Any], tmp_path: Path) -> None:
    attributes = 'VehicleID="400" NumberWaypointsToServe="15" NumberWaypointsOverlap="5"'
    rig = Rig(tmp_path, MANAGER, **{MANAGER: attributes})
    rig.tell(*of(recorded, "AutomationResponse"))
    (ours,), (theirs,) = rig.got("MissionCommand"), of(recorded, "MissionCommand")
    assert [w.Number for w in ours.WaypointList] == [w.Number for w in theirs.WaypointList]
