"""The planning pipeline on the bus: messages of UxAS in order, and how a failed request ends."""

import math
from itertools import pairwise

import pytest
from pipeline_messages import STEPS
from planning_tools import mission

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.plan import make_plan
from cratous.spec.errors import NoPlan


def test_the_pipeline_speaks_the_messages_of_uxas_in_order():
    of = mission(relations=".(p1 p2)-[60000-200000]")
    bus = Bus(lmcp.full_names)
    seen = []
    bus.tap(lambda e: seen.append((e.topic.rsplit(".", 1)[-1], e.source, e.body)))
    plan = make_plan(of, bus)
    names = [name for name, _, _ in seen]
    places = [names.index(name) for name in ("AutomationRequest", *STEPS, "AutomationResponse")]
    assert places == sorted(places)
    assert names.count("TaskPlanOptions") == 2
    assert names.count("AutomationResponse") == 1

    by_name = {name: body for name, _, body in seen}
    offered = {
        (o.TaskID, o.OptionID): o for name, _, b in seen if name == "TaskPlanOptions"
        for o in b.Options
    }  # fmt: skip
    matrix = by_name["AssignmentCostMatrix"].CostMatrix
    assert {(r.DestinationTaskID, r.DestinationTaskOption) for r in matrix} == set(offered)
    for item, told in zip(plan.items, by_name["TaskAssignmentSummary"].TaskList, strict=True):
        assert (told.TaskID, told.OptionID) == (item.task_id, item.option_id)
        assert told.AssignedVehicle == item.vehicle_id
        assert told.TimeTaskCompleted == item.end_ms
        assert offered[item.task_id, item.option_id].Cost == item.end_ms - item.start_ms

    projection = Projection(of.frame)
    commands = {c.VehicleID: c for c in by_name["AutomationResponse"].MissionCommandList}
    assert set(commands) == {item.vehicle_id for item in plan.items}
    for number, command in commands.items():
        points = command.WaypointList
        assert [w.Number for w in points] == list(range(1, len(points) + 1))
        assert all(a.NextWaypoint == b.Number for a, b in pairwise(points))
        flown = [projection.to_local(w.Latitude, w.Longitude) for w in points]
        planned = [p for item in plan.chain(number) for p in (*item.transit[:-1], *item.path)]
        assert len(flown) == len(planned)
        assert max(math.dist(a, b[:2]) for a, b in zip(flown, planned, strict=True)) < 1e-4
    waits = [
        a for c in commands.values() for w in c.WaypointList for a in w.VehicleActionList
        if type(a).__name__ == "LoiterAction"
    ]  # fmt: skip
    held = [item for item in plan.items if item.hold]
    assert [a.Duration for a in waits] == [item.wait_ms for item in held]
    assert waits[0].Radius == pytest.approx(held[0].hold.radius_m)


def test_a_failed_request_ends_in_an_error_status_with_the_reasons():
    bus = Bus(lmcp.full_names)
    said = []
    bus.tap(lambda e: said.append(e.body) if e.topic.endswith("ServiceStatus") else None)
    with pytest.raises(NoPlan) as error:
        make_plan(mission(relations="|(p1_[0-60000] p2_[0-60000])"), bus)
    assert said[-1].StatusType == lmcp.enums["ServiceStatusType"].Error
    told = [pair.Value for pair in said[-1].Info if pair.Key == "reason"]
    assert tuple(told) == error.value.reasons
    # the bus is fit for the next request
    assert make_plan(mission(relations="|(p1 p2)"), bus).items
