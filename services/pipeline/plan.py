"""Plan a mission: one automation request to the services of the pipeline, on a bus.

AutomationRequest -> validator -> UniqueAutomationRequest -> tasks -> TaskPlanOptions
-> route aggregator and planner -> AssignmentCostMatrix -> branch and bound
-> TaskAssignmentSummary -> plan builder and tasks -> UniqueAutomationResponse
-> validator -> AutomationResponse
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from cratous.bridge import lmcp
from cratous.core.assignment.problem import START, Placed
from cratous.services.bus import Bus, Envelope
from cratous.services.pipeline.aggregator import RouteAggregatorService
from cratous.services.pipeline.assignment import AssignmentTreeBranchBoundService
from cratous.services.pipeline.builder import PlanBuilderService
from cratous.services.pipeline.contexts import Context, Contexts
from cratous.services.pipeline.mission_source import MissionSource
from cratous.services.pipeline.planner import RoutePlannerVisibilityService
from cratous.services.pipeline.tasks import TaskService
from cratous.services.pipeline.validator import LINE, AutomationRequestValidatorService
from cratous.services.planning import stages, without_vehicles
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.mission_assign import parts_in, power_w
from cratous.services.planning.omitted_tasks import NothingDone
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Mission
from cratous.spec.mission.changes import with_choices
from cratous.spec.mission.plan import COST_UNITS, LeftOut, Plan, Pose, partial

LIMIT_MS = 5000
"""Time limit of a request [ms]; no virtual time passes during planning here."""


class MissionRequests:
    """The client for a mission's plans: it records the services' messages about its requests.

    shared: RequestIDs used on this bus; certificate: of the newest assignment; told: messages about the
    present request, by type.
    """

    name = "Mission"
    subscribes: tuple[str, ...] = (
        "uxas.messages.task.UniqueAutomationRequest",
        "uxas.messages.task.TaskAssignmentSummary",
        "afrl.cmasi.ServiceStatus",
        "afrl.cmasi.AutomationResponse",
    )

    def __init__(self) -> None:
        self.shared: dict[str, Any] = {}
        self.certificate: dict[str, Any] | None = None
        self.told: dict[str, list[Any]] = {}

    def start(self) -> MissionRequests:
        return self

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        self.told.setdefault(type(envelope.body).__name__, []).append(envelope.body)
        return state, ()

    def newest(self, kind: str) -> Any:
        """The newest message of a type, None if none came."""
        return next(reversed(self.told.get(kind, ())), None)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why there is no plan, as reported by the services."""
        said = self.told.get("ServiceStatus", ())
        errors = [body for body in said if body.StatusType.name == "Error"]
        return tuple(p.Value for body in errors for p in body.Info if p.Key == "reason")


def make_plan(
    mission: Mission,
    bus: Bus | None = None,
    *,
    starts: Mapping[int, Pose] | None = None,
    done: Iterable[Any] = (),
    now_ms: int = 0,
    absent: Mapping[int, str] | None = None,
    undone: Mapping[int, str] | None = None,
    begun: Collection[int] = (),
) -> Plan:
    """The best plan found for the mission; a `PartialPlan` if not all of it can be done.

    BadInput for a bad start, NoPlan with reasons if nothing can be done.

    bus: carries the planning messages (its own if None); its queue is run until empty, and the services leave
    it afterwards. starts: present poses by vehicle id, instead of the mission's; done: tasks already flown,
    as (task_id, start_ms, end_ms) or anything with these attributes; now_ms: departure time of the vehicles;
    absent: vehicles missing from the mission as known, with the reason; undone: tasks that ended undone, with
    the reason; begun: tasks that have begun but not ended, which fix the choice of a `+`. In flight (starts
    given), a vehicle inside a zone is no bad input: its routes begin with the shortest level way out; and
    there may be nothing left to do.
    """
    flying = starts is not None
    if not mission.tasks and flying:
        return stages.nothing_asked(mission)
    bus = Bus(lmcp.full_names) if bus is None else bus
    poses, fixed = stages.start_poses(mission, starts), stages.fixed_tasks(done)
    mission = with_choices(mission, {*begun, *(task.task_id for task in fixed)})
    inputs = Inputs(
        mission, poses, fixed, now_ms, flying, absent or {}, undone or {}, frozenset(begun)
    )
    inputs.check_starts()
    if not inputs.wanted:
        return _nothing_wanted(inputs)
    if not mission.vehicles:
        raise NothingDone(without_vehicles.why_none(inputs), without_vehicles.unable(inputs))
    requests = requests_on(bus)
    source = MissionSource(inputs)
    with services_on(bus, inputs, Contexts(source), requests) as contexts:
        bus.publish(source.request, MissionRequests.name)
        bus.run()
        plan = _answered(requests, contexts)
    requests.told = {}
    return plan


def _nothing_wanted(inputs: Inputs) -> Plan:
    """The plan when no task is left to do."""
    plan = stages.nothing_left(inputs.mission, inputs.branches, inputs.fixed)
    left = tuple(LeftOut(task, why) for task, why in without_vehicles.unable(inputs).items())
    return partial(plan, left, True) if left else plan


def requests_on(bus: Bus) -> MissionRequests:
    """The client that requests plans on a bus; it joins the bus at first use."""
    if MissionRequests.name not in bus.names():
        bus.add(MissionRequests())
    found: MissionRequests = bus.state(MissionRequests.name)
    found.told = {}
    found.certificate = None
    return found


@contextmanager
def services_on(
    bus: Bus, inputs: Inputs, contexts: Contexts, requests: MissionRequests
) -> Iterator[Contexts]:
    """Context manager: the services of the pipeline on a bus, for one request of a mission."""
    services: list[Any] = [
        contexts,
        AutomationRequestValidatorService(requests.shared, contexts, LIMIT_MS),
        RouteAggregatorService(contexts),
        RoutePlannerVisibilityService(contexts),
        *(TaskService(contexts, task.id, task.kind) for task in inputs.mission.tasks),
        AssignmentTreeBranchBoundService(contexts),
        PlanBuilderService(contexts),
    ]
    for service in services:
        bus.add(service)
    try:
        yield contexts
    finally:
        for service in services:
            bus.remove(service.name)
        requests.shared.pop(LINE, None)  # the next request is of another mission


def _answered(requests: MissionRequests, contexts: Contexts) -> Plan:
    """The plan that the services have answered; NoPlan or BadInput with their reasons."""
    unique, response = (
        requests.newest("UniqueAutomationRequest"),
        requests.newest("AutomationResponse"),
    )
    commands = response.MissionCommandList if response is not None else ()
    if not commands:
        error = contexts.error(unique.RequestID) if unique is not None else None
        if isinstance(error, BadInput):
            raise error
        if isinstance(error, NothingDone):
            raise NothingDone(requests.reasons, error.of)
        raise NoPlan(requests.reasons or ("the services have not answered",))
    context = contexts.of(unique.RequestID)
    plan = _exact(context, requests.newest("TaskAssignmentSummary"))
    assert context.assigned is not None
    found = context.assigned
    in_part = tuple(parts_in(context.inputs.options, found.assignment))
    if found.left_out or in_part:
        plan = partial(plan, found.left_out, found.sure, in_part)
    said = {c.VehicleID: _order(c) for c in commands}
    flown = {v: [item.task_id for item in plan.chain(v)] for v in said}
    if said != flown or len(plan.items) != sum(map(len, said.values())):
        raise RuntimeError(f"the commands are of {said}, the plan of {flown}")
    requests.certificate = context.assigned.certificate
    return plan


def _order(command: Any) -> list[int]:
    """The tasks of a MissionCommand, in the order of flight."""
    return list(dict.fromkeys(t for w in command.WaypointList for t in w.AssociatedTasks))


def _exact(context: Context, summary: Any) -> Plan:
    """The plan in the mission frame: times from the summary, routes and constraints from the inputs."""
    inputs = context.inputs
    assert context.assigned is not None
    assert context.assigned.assignment is not None
    free = {vehicle.id: inputs.now_ms for vehicle in inputs.mission.vehicles}
    at: dict[int, int] = {}
    placed = []
    for task in summary.TaskList:
        vehicle = task.AssignedVehicle
        v, k = inputs.vehicle_index[vehicle], inputs.index[task.TaskID, task.OptionID]
        travel = inputs.routes.travel_ms(v, at.get(vehicle, START), k)
        assert travel is not None
        start = task.TimeTaskCompleted - inputs.options[k].duration_ms
        placed.append(
            Placed(v, k, free[vehicle], free[vehicle] + travel, start, task.TimeTaskCompleted)
        )
        free[vehicle], at[vehicle] = task.TimeTaskCompleted, k
    return stages.build(
        inputs.mission,
        inputs.options,
        inputs.routes,
        replace(context.assigned.assignment, placed=tuple(placed)),
        inputs.zones,
        inputs.fixed,
    )


def cost_of(plan: Plan, mission: Mission) -> int:
    """The cost of a plan's own items, in the unit of `COST_UNITS`."""
    if COST_UNITS[plan.cost] != "ms":
        flown = [
            (item, item.arrive_ms - item.depart_ms + item.end_ms - item.start_ms)
            for item in plan.items
        ]
        if plan.cost == "DISTANCE":
            return sum(round(ms * item.speed_m_s) for item, ms in flown)
        return sum(round(ms * power_w(mission.vehicle(item.vehicle_id))) for item, ms in flown)
    last = {item.vehicle_id: item.end_ms for item in plan.items}
    ends = last.values()
    return sum(ends) if plan.cost == "CUMULATIVE" else max(ends, default=0)


def certificate_of(bus: Bus) -> dict[str, Any] | None:
    """The certificate of the last assignment made on a bus; None if there is none."""
    if MissionRequests.name not in bus.names():
        return None
    requests: MissionRequests = bus.state(MissionRequests.name)
    return requests.certificate
