"""Make a plan for a mission: the UxAS planning pipeline as services on a bus, in one call.

AutomationRequest -> validator -> UniqueAutomationRequest -> tasks -> TaskPlanOptions
-> route aggregator and planner -> AssignmentCostMatrix -> branch and bound
-> TaskAssignmentSummary -> plan builder and tasks -> UniqueAutomationResponse
-> validator -> AutomationResponse
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.planning import reasons, stages
from cratous.services.planning.assignment_service import AssignmentTreeBranchBoundService
from cratous.services.planning.builder import PlanBuilderService
from cratous.services.planning.desk import Desk, Inputs
from cratous.services.planning.route_services import (
    RouteAggregatorService,
    RoutePlannerVisibilityService,
)
from cratous.services.planning.task_service import TaskService
from cratous.services.planning.validator import AutomationRequestValidatorService
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Mission
from cratous.spec.plan import Plan, Pose


def join(bus: Bus, mission: Mission) -> Desk:
    """Add the planning services of a mission to a bus, once; the desk they share."""
    try:
        desk: Desk = bus.state(Desk.name)
        return desk
    except KeyError:
        desk = Desk(mission)
    bus.add(desk)
    bus.add(AutomationRequestValidatorService(desk))
    bus.add(RouteAggregatorService(desk))
    bus.add(RoutePlannerVisibilityService(desk))
    for task in mission.tasks:
        bus.add(TaskService(desk, task))
    bus.add(AssignmentTreeBranchBoundService(desk))
    bus.add(PlanBuilderService(desk))
    return desk


def make_plan(
    mission: Mission,
    bus: Bus | None = None,
    *,
    starts: Mapping[int, Pose] | None = None,
    done: Iterable[Any] = (),
    now_ms: int = 0,
    absent: Mapping[int, str] | None = None,
) -> Plan:
    """The best plan found for the mission. BadInput for a bad start, NoPlan with reasons.

    bus: where the planning messages go (its own if None); the services join it on first use and
    its queue is run until it is empty. starts: present poses by vehicle id, instead of the
    mission's; done: tasks already flown, as (task_id, start_ms, end_ms) or anything with these
    attributes; now_ms: when the vehicles set off; absent: vehicles that are not in the mission as it
    is known, with the reason. In flight (starts given) a vehicle inside a
    zone is no bad input: there is just no route from where it is; and nothing may be left to do.
    """
    if not mission.tasks and starts is not None:
        return stages.nothing_asked(mission)
    bus = Bus(lmcp.full_names) if bus is None else bus
    poses = stages.start_poses(mission, starts)
    inputs = Inputs(mission, poses, stages.fixed_tasks(done), now_ms, absent or {})
    if starts is None:
        stages.check_starts(mission, poses, inputs.zones)
    if not inputs.wanted:
        return stages.nothing_left(mission, inputs.branches, inputs.fixed)
    if not mission.vehicles:
        raise NoPlan(reasons.without_options(inputs))
    desk = join(bus, mission)
    key = desk.open(inputs)
    request = lmcp.new(
        "AutomationRequest",
        EntityList=[vehicle.id for vehicle in mission.vehicles],
        TaskList=list(inputs.wanted),
        TaskRelationships=mission.relations,
    )
    bus.publish(request, "Mission")
    bus.run()
    assigned = bus.state(AssignmentTreeBranchBoundService.name)
    if key not in assigned.found:
        raise NoPlan(assigned.failed[key])
    plan: Plan = bus.state(PlanBuilderService.name).plans[key]
    return plan


def cost_of(plan: Plan) -> int:
    """The cost of a plan's own items [ms]: the latest end, or the sum of the vehicles' last ends."""
    last = {item.vehicle_id: item.end_ms for item in plan.items}
    ends = last.values()
    return sum(ends) if plan.cost == "CUMULATIVE" else max(ends, default=0)


def certificate_of(bus: Bus) -> dict[str, Any] | None:
    """The certificate of the last assignment that was made on a bus; None if there is none."""
    try:
        desk: Desk = bus.state(Desk.name)
    except KeyError:
        return None
    return desk.requests[-1].certificate if desk.requests else None
