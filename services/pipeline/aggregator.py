"""RouteAggregatorService: collects routes and options, driven by `core.contracts.checklists`.

Collector: UniqueAutomationRequest -> all TaskPlanOptions -> RoutePlanRequests, one per vehicle -> all
RoutePlanResponses -> AssignmentCostMatrix. Aggregator: RouteRequest -> RoutePlanRequests, one per vehicle ->
RouteResponse. The ids of plan requests are allocated in disjoint blocks, one per request, so that each
response belongs to exactly one.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.contracts.checklists import (
    ASK_ROUTES,
    HAND_OVER,
    NOTHING,
    collector_step,
    free_after,
    list_complete,
    owns,
)
from cratous.services.bus import Envelope, Send
from cratous.services.loading.duplicates import counted_once
from cratous.services.pipeline.compositions import composition, is_choice
from cratous.services.pipeline.contexts import UNIQUE, Contexts
from cratous.services.pipeline.ground import is_ground
from cratous.services.pipeline.planner import straight_costs
from cratous.services.pipeline.request_end import ENDINGS, newest, request_ended
from cratous.spec.errors import CratousError

NAME = "RouteAggregatorService"
OPTIONS = "uxas.messages.task.TaskPlanOptions"
PLANS = "uxas.messages.route.RoutePlanResponse"
ROUTES = "uxas.messages.route.RouteRequest"
AWAITS_OPTIONS = 1
AT_ONCE = 64
"""Most RouteRequests kept at the same time; beyond that the oldest is dropped."""

End = tuple[int, int]
"""Task and option; (0, 0) for a vehicle's position."""


class Block(NamedTuple):
    """The plan requests of one request: first id, vehicles in order, responses by id."""

    first: int = 0
    vehicles: tuple[int, ...] = ()
    plans: tuple[tuple[int, Any], ...] = ()

    def owns(self, number: int) -> bool:
        """Whether an id belongs to this block."""
        return owns(self.first, len(self.vehicles), number)

    @property
    def complete(self) -> bool:
        """Whether all have been answered."""
        have = {number for number, _ in self.plans}
        return list_complete([(self.first + k in have,) for k in range(len(self.vehicles))])

    def plus(self, response: Any) -> Block:
        """The block with a response added; duplicates are ignored."""
        if any(number == response.ResponseID for number, _ in self.plans):
            return self
        return self._replace(plans=(*self.plans, (response.ResponseID, response)))


class Collecting(NamedTuple):
    """One automation request: the kernel's stage, the request, options by task, its routes, and for each
    vehicle the ends of its routes, by RouteID.
    """

    stage: int
    request: Any
    options: dict[int, Any]
    block: Block = Block()
    ends: tuple[tuple[tuple[End, End], ...], ...] = ()


class Open(NamedTuple):
    """The next free id, automation requests by RequestID, route requests in order."""

    free: int
    collecting: dict[int, Collecting]
    routes: tuple[tuple[Any, Block], ...]


Step = tuple[Open, Iterable[Any]]


class RouteAggregatorService:
    """Aggregator and collector."""

    name = NAME
    subscribes: tuple[str, ...] = (UNIQUE, OPTIONS, PLANS, ROUTES, *ENDINGS)
    knows = ("EntityConfiguration", "EntityState")

    def __init__(self, contexts: Contexts, group: str = "", fast: bool = False) -> None:
        """group: address of the planners for waypoints, "" for all planners; fast: costs of ground vehicles
        are taken from straight lines instead of being requested.
        """
        self._contexts, self._group, self._fast = contexts, group, fast

    def start(self) -> Open:
        return Open(1, {}, ())

    def handle(self, state: Open, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            if self._contexts.refused(body.RequestID):
                return state, self._contexts.refusal(body.RequestID)
            once = body.copy(OriginalRequest=counted_once(body.OriginalRequest)[0])
            return self._collect(state, Collecting(AWAITS_OPTIONS, once, {}))
        if topic == OPTIONS:
            mine = state.collecting.get(body.CorrespondingAutomationRequestID)
            if mine is None or body.TaskID not in mine.request.OriginalRequest.TaskList:
                return state, ()
            if body.TaskID in mine.options:
                return state, ()  # the first offer counts: routes may have been requested already
            return self._collect(state, mine._replace(options={**mine.options, body.TaskID: body}))
        if topic == PLANS:
            return self._answered(state, body)
        if topic == ROUTES:
            return self._aggregate(state, body)
        ended = request_ended(topic, body)
        left = {k: v for k, v in state.collecting.items() if k != ended}
        return state._replace(collecting=left), ()

    def _answered(self, state: Open, body: Any) -> Step:
        """Assign a planner's response to the request whose block of ids contains its id; ignore it otherwise."""
        for mine in state.collecting.values():
            if mine.block.owns(body.ResponseID):
                return self._collect(state, mine._replace(block=mine.block.plus(body)))
        for k, (request, block) in enumerate(state.routes):
            if not block.owns(body.ResponseID):
                continue
            block = block.plus(body)
            others = state.routes[:k], state.routes[k + 1 :]
            if block.complete:
                return state._replace(routes=(*others[0], *others[1])), [_reply(request, block)]
            return state._replace(routes=(*others[0], (request, block), *others[1])), ()
        return state, ()

    def _collect(self, state: Open, mine: Collecting) -> Step:
        """Advance the collector of one request until it has to wait."""
        key = mine.request.RequestID
        out: list[Any] = []
        while True:
            tasks = mine.request.OriginalRequest.TaskList
            all_options = list_complete([(task in mine.options,) for task in tasks])
            stage, act = collector_step(mine.stage, all_options, mine.block.complete)
            mine = mine._replace(stage=stage)
            if act == ASK_ROUTES:
                try:
                    state, mine, asked = self._ask(state, mine)
                except CratousError as error:
                    out.append(self._contexts.fail(key, error))
                    break
                out += asked
            elif act == HAND_OVER:
                out.append(_matrix(mine))
                break
            elif act == NOTHING:
                collecting = newest({**state.collecting, key: mine})
                return state._replace(collecting=collecting), out
        left = {k: v for k, v in state.collecting.items() if k != key}
        return state._replace(collecting=left), out

    def _ask(self, state: Open, mine: Collecting) -> tuple[Open, Collecting, list[Any]]:
        """One plan request for each vehicle that has an option, in a block of ids."""
        request = mine.request.OriginalRequest
        context = self._contexts.of(mine.request.RequestID)
        states = {planning.EntityID: planning for planning in mine.request.PlanningStates}
        options = [o for task in request.TaskList for o in mine.options[task].Options]
        may_follow = set(context.inputs.may_follow)
        # of a task that is not a choice of one option, one option may follow another
        told = {task: composition(mine.options[task]) for task in request.TaskList}
        may_follow |= {(task, task) for task, term in told.items() if not is_choice(term)}
        asked: list[Any] = []
        ends: list[tuple[tuple[End, End], ...]] = []
        vehicles: list[int] = []
        for vehicle in context.vehicles:
            able = [o for o in options if not o.EligibleEntities or vehicle in o.EligibleEntities]
            if not able:
                continue
            start = _from(states.get(vehicle) or self._state(vehicle))
            pairs = [((0, 0), start, o) for o in able]
            pairs += [
                ((a.TaskID, a.OptionID), (a.EndLocation, a.EndHeading), b)
                for a in able
                for b in able
                if (a.TaskID, b.TaskID) in may_follow and a is not b
            ]
            vehicles.append(vehicle)
            ends.append(tuple((end, (to.TaskID, to.OptionID)) for end, _, to in pairs))
            asked.append(
                lmcp.new(
                    "RoutePlanRequest",
                    RequestID=state.free + len(asked),
                    VehicleID=vehicle,
                    OperatingRegion=request.OperatingRegion,
                    RouteRequests=[
                        lmcp.new(
                            "RouteConstraints",
                            RouteID=number,
                            StartLocation=place,
                            StartHeading=heading,
                            EndLocation=to.StartLocation,
                            EndHeading=to.StartHeading,
                        )
                        for number, (_, (place, heading), to) in enumerate(pairs)
                    ],
                    IsCostOnlyRequest=True,
                )
            )
        asked, block = self._straight(asked, Block(state.free, tuple(vehicles)))
        state = state._replace(free=free_after(state.free, len(vehicles)))
        return state, mine._replace(block=block, ends=tuple(ends)), asked

    def _straight(self, asked: list[Any], block: Block) -> tuple[list[Any], Block]:
        """The requests still to be sent, and the block with the answers to the others."""
        left = []
        for one in asked:
            if self._fast and is_ground(self._contexts.world, one.VehicleID):
                block = block.plus(straight_costs(self._contexts, one))
            else:
                left.append(one)
        return left, block

    def _state(self, vehicle: int) -> Any:
        """A vehicle's newest state, for requests whose PlanningStates lack it."""
        return self._contexts.world.get("state", vehicle)

    def _aggregate(self, state: Open, request: Any) -> Step:
        """One plan request per vehicle of a RouteRequest; an empty list means all known vehicles."""
        vehicles = list(dict.fromkeys(request.VehicleID))
        vehicles = vehicles or self._contexts.world.ids("configuration")
        block = Block(state.free, tuple(vehicles))
        if block.complete:
            return state, [_reply(request, block)]
        asked = [
            lmcp.new(
                "RoutePlanRequest",
                RequestID=state.free + k,
                AssociatedTaskID=request.AssociatedTaskID,
                VehicleID=vehicle,
                OperatingRegion=request.OperatingRegion,
                RouteRequests=list(request.RouteRequests),
                IsCostOnlyRequest=request.IsCostOnlyRequest,
            )
            for k, vehicle in enumerate(vehicles)
        ]
        if request.IsCostOnlyRequest:
            asked, block = self._straight(asked, block)
        if block.complete:
            free = free_after(state.free, len(vehicles))
            return state._replace(free=free), [_reply(request, block)]
        routes = (*state.routes, (request, block))[-AT_ONCE:]
        state = state._replace(free=free_after(state.free, len(vehicles)), routes=routes)
        if self._group and not request.IsCostOnlyRequest:
            return state, [Send(one, self._group) for one in asked]
        return state, asked


def _from(state: Any) -> tuple[Any, float]:
    if hasattr(state, "PlanningPosition"):
        return state.PlanningPosition, state.PlanningHeading
    return state.Location, state.Heading


def _reply(request: Any, block: Block) -> Any:
    plans = dict(block.plans)
    routes = [plans[block.first + k] for k in range(len(block.vehicles))]
    return lmcp.new("RouteResponse", ResponseID=request.RequestID, Routes=routes)


def _matrix(mine: Collecting) -> Any:
    """The cost matrix of all routes that were found."""
    request, plans = mine.request.OriginalRequest, dict(mine.block.plans)
    rows = []
    for k, vehicle in enumerate(mine.block.vehicles):
        ends = mine.ends[k]
        for plan in plans[mine.block.first + k].RouteResponses:
            if plan.RouteCost < 0 or plan.RouteID not in range(len(ends)):
                continue
            start, to = ends[plan.RouteID]
            rows.append(
                lmcp.new(
                    "TaskOptionCost",
                    VehicleID=vehicle,
                    IntialTaskID=start[0],
                    IntialTaskOption=start[1],
                    DestinationTaskID=to[0],
                    DestinationTaskOption=to[1],
                    TimeToGo=plan.RouteCost,
                )
            )
    return lmcp.new(
        "AssignmentCostMatrix",
        CorrespondingAutomationRequestID=mine.request.RequestID,
        TaskLevelRelationship=request.TaskRelationships,
        TaskList=list(request.TaskList),
        OperatingRegion=request.OperatingRegion,
        CostMatrix=rows,
    )
