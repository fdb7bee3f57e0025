"""The pipeline's services together: what never ends is let go, and two processes plan as one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import option, options, unique
from pipeline_tools import PIPELINE, Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp
from cratous.services.bus import Envelope

AGGREGATOR = "RouteAggregatorService"
ASSIGNMENT, BUILDER = "AssignmentTreeBranchBoundService", "PlanBuilderService"


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
