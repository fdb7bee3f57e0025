"""The route aggregator and the route planner, each alone with the test as its neighbours."""

from __future__ import annotations

from pathlib import Path

import pytest
from pipeline_messages import ended, option, options, planned, unique
from pipeline_tools import Rig, alone, must_fly, place, vehicle

from cratous.bridge import lmcp
from cratous.spec.errors import BadInput

AGGREGATOR, PLANNER = "RouteAggregatorService", "RoutePlannerVisibilityService"


collector = alone(AGGREGATOR)


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


@pytest.mark.shows("RoutePlannerService", "RoutePlanRequest", "RoutePlanResponse", "AircraftPathPlanner", "OwnRoutePlanner",
    "EntityConfiguration", "EntityState", "KeepInZone", "KeepOutZone", "OperatingRegion",
)  # fmt: skip
def test_the_planner_of_older_configurations_answers_alike(tmp_path: Path) -> None:
    answers = []
    for name in (PLANNER, "RoutePlannerService"):
        (tmp_path / name).mkdir()
        rig = Rig(tmp_path / name, name)
        box = lmcp.new("Rectangle", CenterPoint=place(0.02), Width=800.0, Height=800.0)
        inside = lmcp.new("Rectangle", CenterPoint=place(0.02), Width=9000.0, Height=9000.0)
        rig.tell(
            *vehicle(1),
            lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box),
            lmcp.new("KeepInZone", ZoneID=9, MaxAltitude=9000.0, Boundary=inside),
            lmcp.new("OperatingRegion", ID=3, KeepOutAreas=[8], KeepInAreas=[9]),
        )
        way = lmcp.new(
            "RouteConstraints", RouteID=4, StartLocation=place(0), EndLocation=place(0.04)
        )
        asked = lmcp.new("RoutePlanRequest", RequestID=9, VehicleID=1, OperatingRegion=3)
        asked = asked.copy(RouteRequests=[way], IsCostOnlyRequest=False)
        rig.tell(asked)
        rig.bus.publish(asked.copy(RequestID=10), "test", address="AircraftPathPlanner")
        rig.bus.run()
        rig.tell(lmcp.new("OwnRoutePlanner", Plans=False), asked.copy(RequestID=11))
        found = rig.got("RoutePlanResponse")
        assert [one.ResponseID for one in found] == [9, 10], "another one plans by then"
        answers.append([one.RouteResponses for one in found])
    assert answers[0] == answers[1]


@pytest.mark.shows(PLANNER, "TurnRadiusOffset_m")
def test_turns_may_be_planned_wider(tmp_path: Path) -> None:
    costs = []
    for offset in ("0", "100"):
        (tmp_path / offset).mkdir()
        rig = Rig(tmp_path / offset, PLANNER, **{PLANNER: f'TurnRadiusOffset_m="{offset}"'})
        way = lmcp.new(
            "RouteConstraints", RouteID=4, StartLocation=place(0), EndLocation=place(0.02),
            StartHeading=180.0, UseStartHeading=True,
        )  # fmt: skip
        rig.tell(*vehicle(1))
        rig.tell(lmcp.new("RoutePlanRequest", RequestID=9, VehicleID=1, RouteRequests=[way]))
        costs.append(rig.got("RoutePlanResponse")[0].RouteResponses[0].RouteCost)
    # about half a circle of a radius that is 110 m wider, less what that brings it nearer
    assert 8_000 < costs[1] - costs[0] < 1000 * 3.1416 * 110 / 20 + 2000
    with pytest.raises(BadInput, match="TurnRadiusOffset_m"):
        Rig(tmp_path, PLANNER, **{PLANNER: 'TurnRadiusOffset_m="-5"'})


@pytest.mark.shows(AGGREGATOR, "FastPlan", "RouteRequest", "RouteResponse")
def test_what_drives_may_cost_what_a_straight_line_costs(tmp_path: Path) -> None:
    rig = Rig(tmp_path, AGGREGATOR, **{AGGREGATOR: 'FastPlan="TRUE"'})
    profile = {"NominalSpeed": 10.0, "MaximumSpeed": 20.0}
    rig.tell(
        *vehicle(1),
        lmcp.new("GroundVehicleConfiguration", ID=3, **profile),
        lmcp.new("GroundVehicleState", ID=3, Location=place(0)),
    )
    way = lmcp.new("RouteConstraints", RouteID=4, StartLocation=place(0), EndLocation=place(0.01))
    asked = lmcp.new("RouteRequest", RequestID=9, VehicleID=[3], RouteRequests=[way])
    rig.tell(asked.copy(IsCostOnlyRequest=True))
    assert not rig.got("RoutePlanRequest")
    (answer,) = rig.got("RouteResponse")
    cost = answer.Routes[0].RouteResponses[0].RouteCost
    assert cost == pytest.approx(0.01 * 110_574 / 10 * 1000, rel=1e-3)
    rig.tell(asked.copy(RequestID=10, VehicleID=[1, 3], IsCostOnlyRequest=True))
    (flown,) = rig.got("RoutePlanRequest")
    assert flown.VehicleID == 1, "what flies is planned for as ever"
    rig.tell(planned(flown, 10))
    assert [r.VehicleID for r in rig.got("RouteResponse")[1].Routes] == [1, 3]
    rig.tell(asked.copy(RequestID=11, IsCostOnlyRequest=False))
    assert rig.got("RoutePlanRequest")[1].VehicleID == 3, "waypoints lead along roads"
    rig.tell(asked.copy(RequestID=12, VehicleID=[3], OperatingRegion=77, IsCostOnlyRequest=True))
    assert rig.got("RouteResponse")[2].Routes[0].RouteResponses[0].RouteCost == -1


@pytest.mark.shows(AGGREGATOR, "FastPlan", "AssignmentCostMatrix")
def test_a_matrix_of_what_drives_needs_no_planner(tmp_path: Path) -> None:
    rig = Rig(tmp_path, AGGREGATOR, **{AGGREGATOR: 'FastPlan="TRUE"'})
    rig.tell(
        lmcp.new("GroundVehicleConfiguration", ID=1, NominalSpeed=10.0, MaximumSpeed=20.0),
        lmcp.new("GroundVehicleState", ID=1, Location=place(0)),
        must_fly(5),
        lmcp.new("TaskInitialized", TaskID=5),
    )
    rig.tell(unique(3, 5, vehicles=(1,)), options(3, 5, option(5, 1, 1)))
    (matrix,) = rig.got("AssignmentCostMatrix")
    assert [row.VehicleID for row in matrix.CostMatrix] == [1]
