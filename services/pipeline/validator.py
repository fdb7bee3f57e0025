"""AutomationRequestValidatorService: the queue of requests, driven by the proved `line_step`.

Every request gets a ticket on arrival. When its turn comes it is validated against what is known
(`validity`): a valid one is published as UniqueAutomationRequest; one that lacks only initialised tasks waits
(except for kinds that no service handles: `external_tasks`); any other is answered with the reasons. One is in the
pipeline at a time; each is answered once, in order, by its response, by an error, or when its time limit is
over.

A TaskAutomationRequest keeps its RequestID unless that was used recently; all others are numbered in order of
arrival. A validator restarted in the same process continues the queue of the previous one.

A request is published as received, but for ids that it lists several times (`counted_once`). Its tasks, vehicles and relations are interpreted by the planning
services, so that a client's request reaches planners of any kind; if it can be interpreted here, tasks that
the relations omit are removed, and planning states are added.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.contracts import requests
from cratous.core.contracts.requests import Line, line_step
from cratous.services.bus import Envelope, Wake
from cratous.services.loading.duplicates import counted_once
from cratous.services.pipeline.answers import Asked, answer, asked_of, refusal
from cratous.services.pipeline.contexts import Context, Contexts
from cratous.services.pipeline.external_tasks import Unserved
from cratous.services.pipeline.relative_tasks import FOLLOWED
from cratous.services.pipeline.status import status
from cratous.services.pipeline.tasks import TASKS
from cratous.services.pipeline.validity import things_of, verdict

NAME = "AutomationRequestValidatorService"
RESPONSE = "uxas.messages.task.UniqueAutomationResponse"
STATUS = "afrl.cmasi.ServiceStatus"
INITIALISED = "uxas.messages.task.TaskInitialized"
MANAGER = "TaskManagerService"
CMASI_TASK, REMOVE = "afrl.cmasi.Task", "afrl.cmasi.RemoveTasks"
REMEMBERED = 4096
"""Most recent RequestIDs that are not reused."""
LINE = "line of requests"
"""Key under which unanswered requests are kept, for a later validator on the bus."""
REQUESTS = (
    "afrl.cmasi.AutomationRequest",
    "afrl.impact.ImpactAutomationRequest",
    "uxas.messages.task.TaskAutomationRequest",
)


class Requests(NamedTuple):
    """line: the kernel's; asked: requests by ticket, each with its RequestID; published: whether the request
    whose turn it is is published; initialised: tasks that have reported so; notes: for its answer;
    unserved: tasks without a service.
    """

    line: Line
    asked: dict[int, Asked]
    published: bool
    initialised: frozenset[int]
    notes: tuple[str, ...] = ()
    unserved: Unserved = Unserved()

    @property
    def work(self) -> int:
        """RequestID of the request in the pipeline, 0 for none."""
        if not (self.line.busy and self.published):
            return 0
        return self.asked[self.line.answered].number


Step = tuple[Requests, Iterable[Any]]


class AutomationRequestValidatorService:
    """Automation requests of three kinds -> UniqueAutomationRequest -> their responses."""

    name = NAME
    subscribes: tuple[str, ...] = (
        *REQUESTS,
        RESPONSE,
        STATUS,
        INITIALISED,
        CMASI_TASK,
        REMOVE,
        "afrl.cmasi.EntityState",
        "afrl.cmasi.EntityConfiguration",
        "afrl.cmasi.AbstractZone",
        "afrl.cmasi.OperatingRegion",
    )

    def __init__(self, shared: dict[str, Any], contexts: Contexts, limit_ms: int) -> None:
        """shared: keeps the used RequestIDs and the queue, also for a later validator on the bus."""
        self._shared, self._contexts, self._limit_ms = shared, contexts, limit_ms

    def start(self) -> Requests:
        """The state in which the previous validator stopped."""
        kept: Requests | None = self._shared.get(LINE)
        return kept or Requests(Line(0, 0, False, 0), {}, False, frozenset())

    def begin(self, state: Requests) -> Step:
        """Repeat the pending wake-ups of the previous validator."""
        line = state.line
        wakes = (Wake(0, line.answered), Wake(self._limit_ms, line.answered)) if state.asked else ()
        return state, (*wakes, *state.unserved.wakes())

    def handle(self, state: Requests, envelope: Envelope, now_ms: int) -> Step:
        return self._kept(self._handled(state, envelope, now_ms))

    def _kept(self, step: Step) -> Step:
        self._shared[LINE] = step[0]
        return step

    def _handled(self, state: Requests, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        out: list[Any] = []
        if topic in REQUESTS:
            state = self._arrive(state, asked_of(topic, body, envelope.seq), out, now_ms)
        elif topic == RESPONSE:
            state = self._respond(state, body, out, now_ms)
        elif topic == STATUS:
            state = self._fail(self._noted(state, body), body, out, now_ms)
        elif topic == INITIALISED:
            unserved = state.unserved.without([body.TaskID])
            initialised = state.initialised | {body.TaskID}
            state = state._replace(initialised=initialised, unserved=unserved)
        elif topic == REMOVE:
            unserved = state.unserved.without(body.TaskList)
            initialised = state.initialised - set(body.TaskList)
            state = state._replace(initialised=initialised, unserved=unserved)
        elif hasattr(body, "TaskID"):  # a replaced task has to initialise itself again
            state = state._replace(initialised=state.initialised - {body.TaskID})
            unserved = state.unserved.without([body.TaskID])
            if topic not in (*TASKS, *FOLLOWED) and self._contexts.source.asks(MANAGER):
                unserved, wake = unserved.arrived((body.TaskID, envelope.seq), topic)
                out.append(wake)
            state = state._replace(unserved=unserved)
        return self._pump(state, out, now_ms), out

    def wake(self, state: Requests, key: Any, now_ms: int) -> Step:
        """A request's time may be over, as the kernel decides, or that of an unserved task."""
        out: list[Any] = []
        if isinstance(key, tuple):
            state = state._replace(unserved=state.unserved.due(key))
        return self._kept((self._pump(state, out, now_ms), out))

    def _step(
        self, state: Requests, event: int, ticket: int, now_ms: int
    ) -> tuple[Requests, int, int]:
        line, act, about = line_step(state.line, event, ticket, now_ms, self._limit_ms)
        return state._replace(line=line), act, about

    def _arrive(self, state: Requests, asked: Asked, out: list[Any], now_ms: int) -> Requests:
        state, act, ticket = self._step(state, requests.ARRIVAL, 0, now_ms)
        if act != requests.TAKE:
            out += refusal(asked, 0, ["no more requests are taken"])
            return state
        asked = asked._replace(number=self._number(asked.number))
        return state._replace(asked={**state.asked, ticket: asked})

    def _number(self, wanted: int) -> int:
        """The requested RequestID if no recent request has used it, else the next free one."""
        shared = self._shared
        used: dict[int, None] = shared.setdefault("RequestIDs", {})
        number = wanted
        if not wanted or wanted in used:
            number = shared.get("requests", 0) + 1
            while number in used:
                number += 1
            shared["requests"] = number
        used[number] = None
        if len(used) > REMEMBERED:
            used.pop(next(iter(used)))
        return number

    def _respond(self, state: Requests, body: Any, out: list[Any], now_ms: int) -> Requests:
        # before the request is published, no response can be its own
        ticket = state.line.answered if state.work and body.ResponseID == state.work else -1
        state, act, ticket = self._step(state, requests.ANSWER, ticket, now_ms)
        if act != requests.PASS_ON:
            text = "a response that nobody waits for (late, or of another request)"
            out.append(status(body.ResponseID, "Warning", [("reason", text)]))
            return state
        out.append(answer(state.asked[ticket], body, state.notes))
        return _done(state, ticket)

    def _noted(self, state: Requests, body: Any) -> Requests:
        """Add a warning about a task left out or done in part to the answer of the request in the pipeline."""
        facts = {pair.Key: pair.Value for pair in body.Info}
        if body.StatusType.name != "Warning" or "TaskID" not in facts or not state.work:
            return state
        if facts.get("RequestID") != str(state.work):
            return state
        kind = "in part" if "share" in facts else "left out"
        return state._replace(notes=(*state.notes, f"{kind}: {facts.get('reason', '')}"))

    def _fail(self, state: Requests, body: Any, out: list[Any], now_ms: int) -> Requests:
        """An error ends the request that it names; without a name, the one in the pipeline."""
        if body.StatusType.name != "Error" or not state.work:
            return state
        facts = {pair.Key: pair.Value for pair in body.Info}
        if facts.get("RequestID", str(state.work)) != str(state.work):
            return state
        why = [p.Value for p in body.Info if p.Key == "reason"]
        why = why or [f"{p.Key}: {p.Value}" for p in body.Info] or ["a service reports an error"]
        return self._refuse(state, why, out, now_ms, said=True)

    def _refuse(
        self, state: Requests, why: Iterable[str], out: list[Any], now_ms: int, said: bool = False
    ) -> Requests:
        """Answer the request whose turn it is with an error. said: its status has already been published."""
        state, act, ticket = self._step(state, requests.ANSWER, state.line.answered, now_ms)
        if act == requests.PASS_ON:
            asked = state.asked[ticket]
            out += refusal(asked, asked.number, list(why))[1 if said else 0 :]
        return _done(state, ticket)

    def _pump(self, state: Requests, out: list[Any], now_ms: int) -> Requests:
        """Process everything that is due."""
        while True:
            if state.line.busy and not state.published:
                ticket = state.line.answered
                state = self._begin(state, out, now_ms)
                if ticket != state.line.answered:
                    continue  # it was refused
            state, act, ticket = self._step(state, requests.PUMP, 0, now_ms)
            if act == requests.GIVE_UP:
                why = [f"no response within MaxResponseTime_ms = {self._limit_ms}"]
                if not state.published:
                    why = [*self._verdict(state, state.asked[ticket]).reasons, *why]
                out += refusal(state.asked[ticket], state.asked[ticket].number, why)
                state = _done(state, ticket)
            elif act == requests.PUBLISH:
                out.append(Wake(self._limit_ms, ticket))
            else:
                return state

    def _verdict(self, state: Requests, asked: Asked) -> Any:
        given = {planning.EntityID for planning in asked.states}
        world, nobody = self._contexts.world, state.unserved.named
        things = things_of(asked.request, given, world, state.initialised, nobody)
        return verdict(things)

    def _begin(self, state: Requests, out: list[Any], now_ms: int) -> Requests:
        """Publish the request whose turn it is if it is valid; refuse it if it can never become so."""
        asked = state.asked[state.line.answered]
        number = asked.number
        found = self._verdict(state, asked)
        if found.waits:
            return state
        if not found.valid:
            return self._refuse(state, found.reasons, out, now_ms)
        request, twice = counted_once(asked.request)
        unique = lmcp.new(
            "UniqueAutomationRequest",
            RequestID=number,
            OriginalRequest=request,
            SandBoxRequest=asked.sandbox,
            PlanningStates=asked.states,
        )
        where = f"{type(asked.body).__name__} (message {asked.seq})"
        pairs = getattr(asked.body, "OverridePlanningConditions", ())
        self._contexts.source.conditions(number, pairs)
        context = self._contexts.open(unique, where)
        if not isinstance(context, Context):
            # valid, but it cannot be planned: the planning services report why
            out.append(unique)
            return state._replace(published=True, notes=())
        out.append(self._complete(unique, context))
        left = set(request.TaskList) - set(context.inputs.wanted)
        notes = twice
        if left:
            names = ", ".join(map(str, sorted(left)))
            notes.append(f"tasks not named in TaskRelationships, so not done: {names}")
        out += [status(number, "Warning", [("reason", note)]) for note in notes]
        return state._replace(published=True, notes=tuple(notes))

    def _complete(self, unique: Any, context: Context) -> Any:
        """The request without tasks that are not to be done, and with each vehicle's planning state."""
        inputs, request = context.inputs, unique.OriginalRequest
        tasks = [task for task in request.TaskList if task in inputs.wanted]
        if tasks != request.TaskList:
            request = request.copy(TaskList=tasks)
        states = []
        for vehicle in context.vehicles:
            place, heading_deg = context.places.sent(inputs.starts[vehicle])
            states.append(
                lmcp.new(
                    "PlanningState",
                    EntityID=vehicle,
                    PlanningPosition=place,
                    PlanningHeading=heading_deg,
                )
            )
        made = unique.copy(OriginalRequest=request, PlanningStates=states)
        self._contexts.put(made, context)
        return made


def _done(state: Requests, ticket: int) -> Requests:
    left = {k: v for k, v in state.asked.items() if k != ticket}
    return state._replace(asked=left, published=False, notes=())
