"""A task's service: the nine states of `core.contracts.tasks`, driven by messages.

UniqueAutomationRequest -> SensorFootprintRequests -> SensorFootprintResponse -> RoutePlanRequests ->
RoutePlanResponses -> TaskPlanOptions; TaskImplementationRequest -> RoutePlanRequest -> RoutePlanResponse ->
TaskImplementationResponse; vehicle states -> TaskActive, TaskComplete, and camera commands
(VehicleActionCommand). Questions before options are offered: `questions`. Options and routes are those of
`services.planning`; their messages: `implementation`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from cratous.bridge import lmcp
from cratous.core.contracts.tasks import task_step
from cratous.services.bus import Envelope
from cratous.services.pipeline import planner, questions, sensors
from cratous.services.pipeline.contexts import UNIQUE, Context, Contexts
from cratous.services.pipeline.implementation import implemented, offer, way_asked
from cratous.services.pipeline.mission_end import MISSION, plan_that_ends
from cratous.services.pipeline.off_plan import (
    ALONE,
    AUTHORITY,
    HANDED_BACK,
    WITH_UXAS,
    away_after,
    on_its_way,
)
from cratous.services.pipeline.passing import passing_of
from cratous.services.pipeline.questions import Asked
from cratous.services.pipeline.request_end import request_ended
from cratous.services.pipeline.status import status
from cratous.services.pipeline.steering import Steering, last_look, look_command, steering_of
from cratous.services.pipeline.task_state import State
from cratous.services.planning.options import Option
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission import Task, TaskKind

TASKS = {
    "afrl.cmasi.LineSearchTask": TaskKind.LINE_SEARCH,
    "afrl.cmasi.PointSearchTask": TaskKind.POINT_SEARCH,
    "afrl.cmasi.AreaSearchTask": TaskKind.AREA_SEARCH,
    "afrl.cmasi.MustFlyTask": TaskKind.MUST_FLY,
    "afrl.cmasi.LoiterTask": TaskKind.LOITER,
    "afrl.impact.ImpactLineSearchTask": TaskKind.LINE_SEARCH,
    "afrl.impact.ImpactPointSearchTask": TaskKind.POINT_SEARCH,
    "afrl.impact.AngledAreaSearchTask": TaskKind.AREA_SEARCH,
    "afrl.impact.PatternSearchTask": TaskKind.PATTERN_SEARCH,
    "afrl.impact.WatchTask": TaskKind.POINT_SEARCH,  # of a stationary entity, as in the loader
}
NAMES = {
    TaskKind.LINE_SEARCH: "CmasiLineSearchTaskService",
    TaskKind.POINT_SEARCH: "CmasiPointSearchTaskService",
    TaskKind.MUST_FLY: "MustFlyTaskService",
    TaskKind.LOITER: "LoiterTaskService",
    TaskKind.AREA_SEARCH: "CmasiAreaSearchTaskService",
    TaskKind.PATTERN_SEARCH: "PatternSearchTaskService",
}
REMOVE = "afrl.cmasi.RemoveTasks"
ROUTES_FROM = 2**60
"""Ids of a task's own route requests start here, beyond the aggregator's blocks."""

INITIALISED, REQUESTED, SENSORS_KNOWN, ROUTES_KNOWN, CHOSEN, FINAL_KNOWN = 1, 2, 3, 4, 5, 6
LISTED, UNLISTED, ENDED, WITHDRAWN, PROCEED = 7, 8, 9, 10, 11
ANNOUNCE, ASK_SENSORS, ASK_ROUTES, PUBLISH_OPTIONS = 1, 2, 3, 4
ASK_FINAL, PUBLISH_PLAN, STEER, COMPLETE, STALE = 5, 6, 7, 8, 9
SELECTED, ACTIVE = 6, 7
_EVENTS = {
    questions.SENSORS: SENSORS_KNOWN,
    "uxas.messages.task.TaskImplementationRequest": CHOSEN,
    "uxas.messages.route.RoutePlanResponse": FINAL_KNOWN,
}


def nothing() -> None:
    """Nothing has to be done when a task is removed."""


class TaskService:
    """The service of one task; it lives until it is killed."""

    subscribes: tuple[str, ...] = (
        UNIQUE,
        questions.SENSORS,
        "uxas.messages.task.TaskImplementationRequest",
        "uxas.messages.route.RoutePlanResponse",
        "uxas.messages.task.UniqueAutomationResponse",
        "afrl.cmasi.AutomationResponse",
        MISSION,
        "afrl.cmasi.ServiceStatus",
        "afrl.cmasi.EntityState",
        REMOVE,
        AUTHORITY,
        ALONE,
    )

    def __init__(
        self,
        contexts: Contexts,
        task_id: int,
        kind: TaskKind | str,
        ended: Callable[[], None] = nothing,
    ) -> None:
        """kind: of the mission's tasks, or the name of the service; ended: called when the task is removed."""
        self._contexts, self._task_id, self._when_ended = contexts, task_id, ended
        self._request = 0
        self.name = f"{NAMES[kind] if isinstance(kind, TaskKind) else kind}[{task_id}]"

    @property
    def _context(self) -> Context:
        """The context of the request in progress."""
        return self._contexts.of(self._request)

    def _task_in(self, context: Context) -> Task:
        for task in context.inputs.mission.tasks:
            if task.id == self._task_id:
                return task
        raise BadInput(
            "the request does not have this task done",
            item="TaskID",
            expected=", ".join(map(str, context.inputs.wanted)),
            got=str(self._task_id),
        )

    def start(self) -> State:
        return State()

    def begin(self, state: State) -> tuple[State, Iterable[Any]]:
        """Report the task as initialised: it needs nothing for that."""
        return self._advance(state, INITIALISED, 0, None)

    def handle(self, state: State, envelope: Envelope, now_ms: int) -> tuple[State, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == MISSION:
            ends = plan_that_ends(envelope)
            return (state, ()) if ends is None else self.handle(state, ends, now_ms)
        if topic == UNIQUE:
            return self._requested(state, body)
        if topic in _EVENTS:
            return self._reply(state, _EVENTS[topic], body)
        if topic == "uxas.messages.task.UniqueAutomationResponse":
            return self._advance(state, ENDED, state.ticket(body.ResponseID), body)
        if topic == "afrl.cmasi.ServiceStatus":
            ended = request_ended(topic, body)
            return self._advance(state, ENDED, state.ticket(ended), body) if ended else (state, ())
        if topic in ("afrl.cmasi.AutomationResponse", REMOVE):
            if self._withdrawn(state, body):
                return self._advance(state, WITHDRAWN, 0, body)
            return (state, ()) if topic == REMOVE else (self._noted(state, body), ())
        if topic in (AUTHORITY, ALONE):
            if body.VehicleID == state.vehicle:
                state = state._replace(away=away_after(state.away, topic, body))
            return state, ()
        if not hasattr(body, "AssociatedTasks"):
            return state, ()
        if state.away == HANDED_BACK and state.vehicle == body.ID and on_its_way(body):
            state = state._replace(away=WITH_UXAS)
        return (state, ()) if state.away else self._flown(state, body)

    def _requested(self, state: State, body: Any) -> tuple[State, Iterable[Any]]:
        """A request that cannot be planned is answered once per process, and affects no task."""
        number = body.RequestID
        if self._contexts.refused(number):
            return state, self._contexts.refusal(number)
        if self._task_id not in body.OriginalRequest.TaskList:
            return state, ()
        state, ticket = state.arrived(number)
        return self._advance(state, REQUESTED, ticket, body)

    def _flown(self, state: State, body: Any) -> tuple[State, Iterable[Any]]:
        """Process a state of the task's vehicle, which lists the tasks that it flies."""
        if state.vehicle != body.ID:
            return state, ()
        event = LISTED if self._task_id in body.AssociatedTasks else UNLISTED
        steering, out = state.steering, list[Any]()
        if event == UNLISTED and state.task.state == SELECTED and state.passing is not None:
            passing, passed = state.passing.after(body)
            state = state._replace(passing=passing)
            if passed:  # it began and ended since the state before this one
                state, began = self._advance(state, LISTED, 0, body)
                out += began
        state, more = self._advance(state, event, 0, body)
        out += more
        if steering is not None and state.steering is None:
            return state, [*out, last_look(steering, body.ID)]
        if steering is not None and state.task.state == ACTIVE:
            return state, [*out, look_command(steering, body)]
        return state, out

    def _noted(self, state: State, response: Any) -> State:
        """The state with the place of the task in a plan that is sent to its vehicle."""
        if self._contexts.source.outside is None or state.task.state != SELECTED:
            return state
        for command in response.MissionCommandList:
            if command.VehicleID == state.vehicle:
                newest = self._contexts.world.get("state", state.vehicle)
                before = getattr(newest, "CurrentCommand", None)
                return state._replace(passing=passing_of(command, self._task_id, before))
        return state

    def _withdrawn(self, state: State, body: Any) -> bool:
        """Whether the task is removed, or missing from a new plan for its vehicle."""
        if hasattr(body, "TaskList"):
            return self._task_id in body.TaskList
        for command in body.MissionCommandList:
            if command.VehicleID == state.vehicle:
                flown = {t for w in command.WaypointList for t in w.AssociatedTasks}
                return self._task_id not in flown
        return False

    def _reply(self, state: State, event: int, body: Any) -> tuple[State, Iterable[Any]]:
        """Process footprints, routes of options, the choice of an option, or final routes, for this task."""
        if event == CHOSEN:
            if body.TaskID != self._task_id:
                return state, ()
            ticket = state.ticket(body.CorrespondingAutomationRequestID)
            return self._advance(state, event, ticket, body)
        if event == SENSORS_KNOWN:
            tickets = (ticket for ticket, _ in state.tickets)
            ticket = questions.ticket_of_sensors(self._task_id, body.ResponseID, tickets)
            return (state, ()) if ticket < 0 else self._advance(state, event, ticket, body)
        if body.AssociatedTaskID != self._task_id:
            return state, ()
        if body.ResponseID == questions.option_routes_id(state.task.request):
            before = state.asked.waiting
            state = state._replace(asked=state.asked.plus(body))
            if state.asked.waiting or not before:
                return state, ()
            return self._advance(state, ROUTES_KNOWN, state.task.request, body)
        chosen = state.chosen
        if chosen is None:
            return state, ()
        if (body.VehicleID, body.ResponseID) != (chosen.VehicleID, _route_id(chosen)):
            return state, ()
        ticket = state.ticket(chosen.CorrespondingAutomationRequestID)
        return self._advance(state, event, ticket, body)

    def _advance(
        self, state: State, event: int, ticket: int, body: Any
    ) -> tuple[State, Iterable[Any]]:
        """Pass an event to the kernel and carry out its acts, until it has to wait."""
        out: list[Any] = []
        while event:
            task, act = task_step(state.task, event, ticket)
            state = state._replace(task=task)
            self._request = state.number(task.request)
            try:
                state, event = self._do(state, act, body, out)
            except CratousError as error:
                out.append(self._contexts.fail(self._request, error))
                event = WITHDRAWN if act == PUBLISH_PLAN else ENDED
            ticket = state.task.request
        return state, out

    def _do(self, state: State, act: int, body: Any, out: list[Any]) -> tuple[State, int]:
        """Carry out one act of the kernel; returns the event that follows at once, 0 for none."""
        if act == ANNOUNCE:
            out.append(lmcp.new("TaskInitialized", TaskID=self._task_id))
            return state, PROCEED
        if act == ASK_SENSORS:
            clear = state._replace(
                chosen=None, vehicle=0, steering=None, passing=None, asked=Asked(), away=WITH_UXAS
            )
            return self._ask_sensors(clear, out)
        if act == ASK_ROUTES:
            return self._ask_routes(state, body, out)
        if act == PUBLISH_OPTIONS:
            out += [
                status(self._request, "Warning", [("reason", text)])
                for text in state.asked.reasons(self._task_id)
            ]
            out.append(self._offer(self._context, self._left(state, self._context)))
        elif act == ASK_FINAL:
            out.append(way_asked(self._context, self._option(body), body, _route_id(body)))
            return state._replace(chosen=body, vehicle=body.VehicleID), 0
        elif act == PUBLISH_PLAN:
            out += self._plan(state.chosen, body)
            return state._replace(steering=self._steering(state.chosen)), 0
        elif act == STEER:
            out.append(
                lmcp.new(
                    "TaskActive",
                    TaskID=self._task_id,
                    EntityID=body.ID,
                    TimeTaskActivated=body.Time,
                )
            )
        elif act == COMPLETE:
            out.append(self._ended(state, body))
            return state._replace(
                chosen=None, vehicle=0, steering=None, passing=None, away=WITH_UXAS
            ), PROCEED
        return state, 0

    def _ask_sensors(self, state: State, out: list[Any]) -> tuple[State, int]:
        context = self._context
        question = questions.sensor_request(context, self._task_in(context), state.task.request)
        if question is None or not self._contexts.source.asks(sensors.NAME):
            return state, SENSORS_KNOWN
        out.append(question)
        return state, 0

    def _ask_routes(self, state: State, body: Any, out: list[Any]) -> tuple[State, int]:
        context = self._context
        if hasattr(body, "Footprints"):
            blind = questions.blind(context, self._task_in(context), body)
            state = state._replace(asked=state.asked._replace(blind=blind))
        if not self._contexts.source.asks(planner.NAME):
            return state, ROUTES_KNOWN
        options, ticket = self._left(state, context), state.task.request
        asked = questions.route_requests(context, self._task_id, options, ticket)
        out += asked
        waiting = tuple(question.VehicleID for question in asked)
        state = state._replace(asked=state.asked._replace(waiting=waiting))
        return state, 0 if waiting else ROUTES_KNOWN

    def _left(self, state: State, context: Context) -> list[Option]:
        """The options that are offered."""
        return state.asked.left(self._options(context))

    def _options(self, context: Context) -> Sequence[Option]:
        """All options for the task."""
        return context.inputs.options_of(self._task_in(context).id)

    def _offer(self, context: Context, options: list[Option]) -> Any:
        """The TaskPlanOptions."""
        context.offered.add(self._task_id)
        return offer(context, self._task_id, options)

    def _option(self, request: Any) -> Option:
        """The option that an implementation request names, of those for its vehicle."""
        context, who = self._context, request.VehicleID
        made = self._options(context) if self._task_id in context.inputs.wanted else ()
        mine = [option for option in made if who in option.vehicles]
        for option in mine:
            if option.option_id == request.OptionID:
                return option
        raise BadInput(
            f"task {self._task_id} has no such option for vehicle {who}",
            item="TaskImplementationRequest.OptionID",
            expected=", ".join(str(option.option_id) for option in mine) or "none",
            got=str(request.OptionID),
        )

    def _plan(self, request: Any, response: Any) -> list[Any]:
        plan = response.RouteResponses[0] if response.RouteResponses else None
        if plan is None or plan.RouteCost < 0 or not plan.Waypoints:
            why = [pair.Value for pair in plan.RouteError] if plan else ["no route came"]
            raise NoPlan(
                tuple(
                    f"vehicle {request.VehicleID} has no way to task {self._task_id}: {text}"
                    for text in why or ["the planner does not say why"]
                )
            )
        context, outside = self._context, self._contexts.source.outside
        task, option = self._task_in(context), self._option(request)
        return implemented(context, task, option, request, plan, outside)

    def _steering(self, request: Any) -> Steering | None:
        """The camera steering of a vehicle controlled by messages, for the option that it flies."""
        if self._contexts.source.outside is None:
            return None
        context = self._context
        return steering_of(context, self._task_in(context), self._option(request))

    def _ended(self, state: State, body: Any) -> Any:
        """The end of the task: complete if a vehicle flew it and moved on, otherwise undone."""
        if hasattr(body, "AssociatedTasks"):
            return lmcp.new(
                "TaskComplete",
                TaskID=self._task_id,
                EntitiesInvolved=[state.vehicle],
                TimeTaskCompleted=body.Time,
            )
        removed = hasattr(body, "TaskList")
        why = "it was removed" if removed else "its plan was withdrawn or overridden"
        text = f"task {self._task_id} ends undone: {why}"
        return status(0, "Warning", [("TaskID", str(self._task_id)), ("reason", text)])

    def stop(self, state: State) -> None:
        """The task has been removed."""
        self._when_ended()


def _route_id(implementation: Any) -> int:
    return ROUTES_FROM + int(implementation.RequestID)
