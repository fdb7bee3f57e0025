"""RouteAggregatorService and RoutePlannerVisibilityService: from options to the cost matrix."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.assignment import START
from cratous.services.bus import Envelope
from cratous.services.frames import compass
from cratous.services.planning.desk import Desk, Inputs


class Collected(NamedTuple):
    """What has come in for one request."""

    request: Any
    options: dict[int, Any]
    matrix: dict[int, tuple[Any, ...]]


def pairs(inputs: Inputs, vehicle_id: int) -> list[tuple[int, int]]:
    """The routes that a vehicle may need: from its start (START) or an option to an option."""
    mine = [k for k, option in enumerate(inputs.options) if vehicle_id in option.vehicles]
    return [
        (before, to)
        for before in (START, *mine)
        for to in mine
        if before == START
        or (inputs.options[before].task_id, inputs.options[to].task_id) in inputs.may_follow
    ]


class RouteAggregatorService:
    """Once all tasks have offered their options: asks for the routes, publishes the costs.

    RouteID k of a vehicle's request is the k-th of `pairs`.
    """

    name = "RouteAggregatorService"
    subscribes: tuple[str, ...] = (
        "uxas.messages.task.UniqueAutomationRequest",
        "uxas.messages.task.TaskPlanOptions",
        "uxas.messages.route.RoutePlanResponse",
    )

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> dict[int, Collected]:
        return {}

    def handle(
        self, state: dict[int, Collected], envelope: Envelope, now_ms: int
    ) -> tuple[dict[int, Collected], Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "uxas.messages.task.UniqueAutomationRequest":
            return {**state, body.RequestID: Collected(body, {}, {})}, ()
        if envelope.topic == "uxas.messages.task.TaskPlanOptions":
            key = body.CorrespondingAutomationRequestID
            if key not in state:
                return state, ()
            mine = state[key]._replace(options={**state[key].options, body.TaskID: body})
            ready = set(mine.options) >= set(mine.request.OriginalRequest.TaskList)
            return {**state, key: mine}, self._ask(key, mine) if ready else ()
        key = body.ResponseID
        if body.AssociatedTaskID != 0 or key not in state:
            return state, ()
        mine = state[key]._replace(
            matrix={**state[key].matrix, body.VehicleID: self._rows(key, body)}
        )
        vehicles = mine.request.OriginalRequest.EntityList
        if not set(mine.matrix) >= set(vehicles):
            return {**state, key: mine}, ()
        left = {k: v for k, v in state.items() if k != key}
        return left, [self._matrix(key, mine)]

    def _ask(self, key: int, mine: Collected) -> list[Any]:
        inputs = self._desk.inputs(key)
        starts = [self._desk.location(option.start) for option in inputs.options]
        ends = [self._desk.location(option.end) for option in inputs.options]
        asked = []
        for vehicle in mine.request.OriginalRequest.EntityList:
            pose = inputs.starts[vehicle]
            here = self._desk.location(pose)
            asked.append(
                lmcp.new(
                    "RoutePlanRequest",
                    RequestID=key,
                    VehicleID=vehicle,
                    RouteRequests=[
                        lmcp.new(
                            "RouteConstraints",
                            RouteID=number,
                            StartLocation=here if before == START else ends[before],
                            StartHeading=compass(
                                (
                                    pose if before == START else inputs.options[before].end
                                ).heading_rad
                            ),
                            EndLocation=starts[to],
                            EndHeading=compass(inputs.options[to].start.heading_rad),
                        )
                        for number, (before, to) in enumerate(pairs(inputs, vehicle))
                    ],
                    IsCostOnlyRequest=True,
                )
            )
        return asked

    def _rows(self, key: int, response: Any) -> tuple[Any, ...]:
        inputs = self._desk.inputs(key)
        asked = pairs(inputs, response.VehicleID)
        rows = []
        for plan in response.RouteResponses:
            if plan.RouteCost < 0:
                continue
            before, to = asked[plan.RouteID]
            source = None if before == START else inputs.options[before]
            rows.append(
                lmcp.new(
                    "TaskOptionCost",
                    VehicleID=response.VehicleID,
                    IntialTaskID=source.task_id if source else 0,
                    IntialTaskOption=source.option_id if source else 0,
                    DestinationTaskID=inputs.options[to].task_id,
                    DestinationTaskOption=inputs.options[to].option_id,
                    TimeToGo=plan.RouteCost,
                )
            )
        return tuple(rows)

    def _matrix(self, key: int, mine: Collected) -> Any:
        request = mine.request.OriginalRequest
        return lmcp.new(
            "AssignmentCostMatrix",
            CorrespondingAutomationRequestID=key,
            TaskLevelRelationship=request.TaskRelationships,
            TaskList=list(request.TaskList),
            OperatingRegion=request.OperatingRegion,
            CostMatrix=[row for v in request.EntityList for row in mine.matrix[v]],
        )


class Chains(NamedTuple):
    """Routes asked for, by (vehicle, implementation request), and each chain's last option.

    A route is (automation request, option before or START, option to); a chain is known by its
    (automation request, vehicle).
    """

    asked: dict[tuple[int, int], tuple[int, int, int]]
    last: dict[tuple[int, int], int]


class RoutePlannerVisibilityService:
    """RoutePlanRequest -> RoutePlanResponse: costs of many routes, or waypoints of one.

    A route that was not found has the cost -1 and its reason in RouteError. A request for costs
    bears the automation request's id, one for waypoints that of the implementation request, which
    says to which option the route leads; implementations come in the order of flight.
    """

    name = "RoutePlannerVisibilityService"
    subscribes: tuple[str, ...] = (
        "uxas.messages.route.RoutePlanRequest",
        "uxas.messages.task.TaskImplementationRequest",
    )

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> Chains:
        return Chains({}, {})

    def handle(
        self, state: Chains, envelope: Envelope, now_ms: int
    ) -> tuple[Chains, Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "uxas.messages.task.TaskImplementationRequest":
            request_id = body.CorrespondingAutomationRequestID
            chain = (request_id, body.VehicleID)
            to = self._desk.inputs(request_id).index[body.TaskID, body.OptionID]
            way = (request_id, state.last.get(chain, START), to)
            asked = {**state.asked, (body.VehicleID, body.RequestID): way}
            return Chains(asked, {**state.last, chain: to}), ()
        if body.IsCostOnlyRequest:
            plans = self._costs(body)
        else:
            key = (body.VehicleID, body.RequestID)
            if key not in state.asked:
                return state, ()
            plans = [self._waypoints(body.VehicleID, *state.asked[key])]
            left = {k: v for k, v in state.asked.items() if k != key}
            state = state._replace(asked=left)
        answer = lmcp.new(
            "RoutePlanResponse",
            ResponseID=body.RequestID,
            AssociatedTaskID=body.AssociatedTaskID,
            VehicleID=body.VehicleID,
            OperatingRegion=body.OperatingRegion,
            RouteResponses=plans,
        )
        return state, [answer]

    def _costs(self, request: Any) -> list[Any]:
        inputs = self._desk.inputs(request.RequestID)
        vehicle = inputs.vehicle_index[request.VehicleID]
        plans, asked = [], pairs(inputs, request.VehicleID)
        inputs.routes.prepare(vehicle, asked)
        for number, (before, to) in enumerate(asked):
            cost = inputs.routes.travel_ms(vehicle, before, to)
            if cost is not None:
                plans.append(lmcp.new("RoutePlan", RouteID=number, RouteCost=cost))
                continue
            reason = inputs.routes.route(vehicle, before, to).reason
            why = lmcp.new("KeyValuePair", Key="reason", Value=reason)
            plans.append(lmcp.new("RoutePlan", RouteID=number, RouteCost=-1, RouteError=[why]))
        return plans

    def _waypoints(self, vehicle_id: int, request_id: int, before: int, to: int) -> Any:
        inputs = self._desk.inputs(request_id)
        vehicle = inputs.vehicle_index[vehicle_id]
        route = inputs.routes.route(vehicle, before, to)
        speed = inputs.options[to].flyer.speed_m_s
        return lmcp.new(
            "RoutePlan",
            RouteID=1,
            Waypoints=self._desk.waypoints(route.points, 1, speed, ()),
            RouteCost=inputs.routes.travel_ms(vehicle, before, to),
        )
