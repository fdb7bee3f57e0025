"""Missions are planned by the pipeline of UxAS: the same services, and no plan without their kernels."""

from __future__ import annotations

import importlib
import pkgutil
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from planning_tools import FOUR, TWO, mission

from cratous.bridge import lmcp
from cratous.core.contracts.checklists import Collected
from cratous.core.contracts.tasks import Moved
from cratous.services import pipeline
from cratous.services.bus import Bus
from cratous.services.loading import load
from cratous.services.pipeline.contexts import Contexts
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.mission_source import MissionSource
from cratous.services.pipeline.plan import (
    MissionRequests,
    certificate_of,
    make_plan,
    requests_on,
    services_on,
)
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.stages import start_poses
from cratous.services.uxas.published_messages import SERVES
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission.plan import Pose

CROSSING = Path(__file__).parents[2] / "examples" / "crossing" / "mission.yaml"
STEPS = (
    "line_step",
    "request_valid",
    "task_step",
    "collector_step",
    "list_complete",
    "owns",
    "free_after",
    "building_step",
)
"""The kernels of `core.contracts` that every plan of a mission goes through."""


def uses(name: str) -> list[Any]:
    """The modules of the pipeline that call a kernel of `core.contracts` by this name."""
    modules = [
        importlib.import_module(f"{pipeline.__name__}.{found.name}")
        for found in pkgutil.iter_modules(pipeline.__path__)
    ]
    return [module for module in modules if hasattr(module, name)]


def test_planning_the_crossing_calls_the_kernels_of_the_contracts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls: Counter[str] = Counter()

    def counted(name: str, kernel: Any) -> Any:
        def call(*arguments: Any) -> Any:
            calls[name] += 1
            return kernel(*arguments)

        return call

    for name in STEPS:
        for module in uses(name):
            monkeypatch.setattr(module, name, counted(name, getattr(module, name)))
    plan = make_plan(load(CROSSING))
    count = len(plan.items)
    assert count == 2
    assert set(calls) == set(STEPS)
    # an arrival, an answer, and time to look at the line: at least one each
    assert calls["line_step"] >= 3
    # each task: initialised, asked, footprints, routes, chosen, final routes
    assert calls["task_step"] >= 6 * count
    # the assignment, and each part that was built
    assert calls["building_step"] == 1 + count
    # a request of routes, and the costs of them
    assert calls["collector_step"] >= 2


IDLE = {
    "line_step": lambda line, event, ticket, now_ms, limit_ms: (line, 0, 0),
    "request_valid": lambda items: False,
    "task_step": lambda task, event, request: Moved(task, 0),
    "collector_step": lambda stage, options, routes: Collected(stage, 0),
    "list_complete": lambda items: False,
    "owns": lambda first, count, number: False,
    "building_step": lambda building, event, number: (building, 4, number, False),
}
"""Kernels that let nothing happen."""


@pytest.mark.parametrize("name", sorted(IDLE))
def test_no_plan_comes_past_a_kernel(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in uses(name):
        monkeypatch.setattr(module, name, IDLE[name])
    with pytest.raises(NoPlan):
        make_plan(load(CROSSING))


def test_a_mission_has_the_services_of_a_configuration() -> None:
    inputs = Inputs(mission(), start_poses(mission()))
    bus = Bus(lmcp.full_names)
    contexts = Contexts(MissionSource(inputs))
    with services_on(bus, inputs, contexts, requests_on(bus)):
        kinds = {type(bus._services[name]) for name in bus.names()}
    ours = {kind for kind, _ in SERVES.values()}
    assert kinds - ours == {Contexts, MissionRequests}
    assert {kind.__name__ for kind in kinds & ours} == {
        "AutomationRequestValidatorService",
        "RouteAggregatorService",
        "RoutePlannerVisibilityService",
        "TaskService",
        "AssignmentTreeBranchBoundService",
        "PlanBuilderService",
    }
    assert bus.names() == (MissionRequests.name,), "the others have left"


def test_requests_on_one_bus_have_ids_of_their_own_and_the_newest_certificate() -> None:
    bus = Bus(lmcp.full_names)
    numbers: list[int] = []
    bus.tap(
        lambda e: (
            numbers.append(e.body.RequestID)
            if e.topic.endswith(".UniqueAutomationRequest")
            else None
        )
    )
    assert certificate_of(bus) is None
    first = make_plan(mission(), bus)
    assert certificate_of(bus)["sha256"] == first.certificate  # type: ignore[index]
    second = make_plan(mission(FOUR[1:2], TWO[1:], relations="p2"), bus)
    assert certificate_of(bus)["sha256"] == second.certificate != first.certificate  # type: ignore[index]
    with pytest.raises(NoPlan):
        make_plan(mission(relations="|(p1_[0-60000] p2_[0-60000])"), bus)
    assert certificate_of(bus) is None
    assert numbers == [1, 2, 3]


def test_bad_input_stays_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **_more: Any) -> None:
        raise BadInput("a problem that means nothing", item="choices")

    for module in uses("mission_assign"):
        monkeypatch.setattr(module.mission_assign, "assign", refuse)
    with pytest.raises(BadInput, match="a problem that means nothing"):
        make_plan(mission())


# ---- exact places beside messages --------------------------------------------------------------


@pytest.fixture
def places() -> RequestPlaces:
    inputs = Inputs(mission(), start_poses(mission()))
    return RequestPlaces(inputs.mission, inputs.finder)


def test_a_pose_is_read_as_exactly_the_one_that_was_sent(places: RequestPlaces) -> None:
    pose = Pose(1234.567890123, -9876.54321, 701.23456789, 1.23456789)
    place, heading_deg = places.sent(pose)
    assert places.pose(place, heading_deg, "here", "x") == pose
    turned = places.pose(place, heading_deg + 1, "here", "x")
    assert turned[:3] == pose[:3]
    assert turned.heading_rad != pose.heading_rad
    # over the wire it is read from the message
    far = lmcp.binary.unpack(lmcp.binary.pack(place))
    assert places.exact(far, heading_deg) is None
    assert places.pose(far, heading_deg, "here", "x")[:2] == pytest.approx(pose[:2], abs=1e-3)


def test_the_same_numbers_above_ground_are_another_place(places: RequestPlaces) -> None:
    place, heading_deg = places.sent(Pose(10.0, 20.0, 100.0, 0.5))
    low = place.copy(AltitudeType="AGL")
    assert places.exact(low, heading_deg) is None
    assert places.exact(None, heading_deg) is None
