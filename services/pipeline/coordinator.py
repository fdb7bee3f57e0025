"""The service of an AssignmentCoordinatorTask: processes of several vehicles plan one request together.

Each receives the CoordinatedAutomationRequest and sends the others its own vehicle's planning state
(AssignmentCoordination). When all have done so, or MaximumResponseTime has elapsed (kernel `goes_out`), it
sends its own pipeline a TaskAutomationRequest with all received states, sorted by id; the answer is the plan
(AutomationResponse). Since all send the same request, all obtain the same plan.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.tasks.coordination import goes_out
from cratous.services.bus import Envelope, Wake
from cratous.services.pipeline.source import Known
from cratous.services.pipeline.status import status

KIND = "uxas.messages.task.AssignmentCoordinatorTask"
NAME = "AssignmentCoordinatorTaskService"
ASKED = "uxas.messages.task.CoordinatedAutomationRequest"
TOLD = "uxas.messages.task.AssignmentCoordination"
ANSWER = "uxas.messages.task.TaskAutomationResponse"
STATE = "afrl.cmasi.EntityState"
MOST = 64
"""Most pending requests, and most requests with states received; beyond that the oldest is dropped."""
MOST_ENTITIES = 1024
"""Most entities of one request."""


class Waiting(NamedTuple):
    """A CoordinatedAutomationRequest, and when it arrived [ms]."""

    body: Any
    since: int


class Coordinated(NamedTuple):
    """asked: pending requests; told: states by request and entity; out: requests sent out, by number."""

    asked: Mapping[int, Waiting] = MappingProxyType({})
    told: Mapping[int, Mapping[int, Any]] = MappingProxyType({})
    out: Mapping[int, None] = MappingProxyType({})

    def with_told(self, number: int, states: Iterable[Any]) -> Coordinated:
        """The state with planning states added to a request."""
        known = {**self.told.get(number, {}), **{s.EntityID: s for s in states}}
        known = dict(list(known.items())[:MOST_ENTITIES])
        kept = {**self.told, number: known}
        # unknown requests do not displace pending ones
        strangers = [n for n in kept if n not in self.asked]
        for n in strangers[:-MOST]:
            del kept[n]
        return self._replace(told=kept)


Step = tuple[Coordinated, list[Any]]


class AssignmentCoordinatorTaskService:
    """The service of one AssignmentCoordinatorTask."""

    subscribes: tuple[str, ...] = (ASKED, TOLD, ANSWER, STATE)

    def __init__(self, task_id: int, entity: int, world: Known, ended: Callable[[], None]) -> None:
        """entity: the own vehicle, EntityID of the configuration; world: has its newest state; ended: called
        when the task is removed.
        """
        self._task_id, self._entity, self._world, self._when_ended = task_id, entity, world, ended
        self.name = f"{NAME}[{task_id}]"

    def start(self) -> Coordinated:
        return Coordinated()

    def stop(self, state: Coordinated) -> None:
        """The task has been removed."""
        self._when_ended()

    def handle(self, state: Coordinated, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == ASKED:
            return self._asked(state, body, now_ms)
        if topic == TOLD:
            number = body.CoordinatedAutomationRequestID
            if number in state.out or body.PlanningState.EntityID == self._entity:
                return state, []  # too late, or the own state
            return self._checked(state.with_told(number, [body.PlanningState]), number, now_ms)
        if topic == ANSWER:
            if body.ResponseID not in state.out or body.OriginalResponse is None:
                return state, []
            left = {n: None for n in state.out if n != body.ResponseID}
            return state._replace(out={**left, body.ResponseID: None}), [body.OriginalResponse]
        if self._entity != body.ID:
            return state, []
        out = list[Any]()
        for number in list(state.asked):
            if self._entity not in state.told.get(number, {}):
                state, more = self._tell(state, number)
                state, rest = self._checked(state, number, now_ms)
                out += [*more, *rest]
        return state, out

    def wake(self, state: Coordinated, key: Any, now_ms: int) -> Step:
        """A request may be due."""
        return self._checked(state, key, now_ms)

    def _asked(self, state: Coordinated, body: Any, now_ms: int) -> Step:
        number, entities = body.RequestID, body.OriginalRequest.EntityList
        if number in state.asked or number in state.out:
            return state, [self._said("Warning", f"request {number} comes again: the first counts")]
        if not entities or len(entities) > MOST_ENTITIES:
            text = (
                f"request {number}: EntityList: expected 1 to {MOST_ENTITIES} entities to wait for; "
                f"got {len(entities)}"
            )
            return state, [self._said("Error", text)]
        asked = _newest({**state.asked, number: Waiting(body, now_ms)})
        lost = [n for n in state.asked if n not in asked]
        out = [
            self._said("Error", f"request {n}: too many are waited for, it is dropped")
            for n in lost
        ]
        state = state._replace(asked=asked)
        given = {s.EntityID: s for s in body.PlanningStates}
        # a state sent by the entity itself is newer than the request's
        mine = [s for n, s in given.items() if n not in state.told.get(number, {})]
        state = state.with_told(number, [s for s in mine if s.EntityID != self._entity])
        state, more = self._tell(state, number)
        out += more
        if body.MaximumResponseTime >= 0:
            out.append(Wake(body.MaximumResponseTime, number))
        state, more = self._checked(state, number, now_ms)
        return state, [*out, *more]

    def _tell(self, state: Coordinated, number: int) -> Step:
        """Send the own vehicle's planning state, if it takes part."""
        if self._entity not in state.asked[number].body.OriginalRequest.EntityList:
            return state, []
        own = self._world.get("state", self._entity)
        if own is None:
            text = f"request {number}: no state of entity {self._entity}, the own one, has come yet"
            return state, [self._said("Warning", text)]
        planning = lmcp.new(
            "PlanningState",
            EntityID=self._entity,
            PlanningPosition=own.Location,
            PlanningHeading=own.Heading,
        )
        told = lmcp.new(
            "AssignmentCoordination",
            CoordinatedAutomationRequestID=number,
            PlanningState=planning,
        )
        return state.with_told(number, [planning]), [told]

    def _checked(self, state: Coordinated, number: int, now_ms: int) -> Step:
        """Send the request out if all states have arrived or its time is over."""
        waiting = state.asked.get(number)
        if waiting is None:
            return state, []
        body, told = waiting.body, state.told.get(number, {})
        entities = sorted(set(body.OriginalRequest.EntityList))
        missing = [entity for entity in entities if entity not in told]
        if not goes_out(len(missing), waiting.since, now_ms, body.MaximumResponseTime):
            return state, []
        state = state._replace(
            asked={n: w for n, w in state.asked.items() if n != number},
            told={n: t for n, t in state.told.items() if n != number},
        )
        out = list[Any]()
        if missing:
            names = ", ".join(map(str, missing))
            text = f"request {number}: not told in time where they plan from, so left out: {names}"
            out.append(self._said("Warning", text))
        here = [entity for entity in entities if entity in told]
        if not here:
            return state, [
                *out,
                self._said("Error", f"request {number}: nobody is left to plan for"),
            ]
        out.append(
            lmcp.new(
                "TaskAutomationRequest",
                RequestID=number,
                OriginalRequest=body.OriginalRequest.copy(EntityList=here),
                PlanningStates=[told[entity] for entity in here],
            )
        )
        return state._replace(out=_newest({**state.out, number: None})), out

    def _said(self, kind: str, text: str) -> Any:
        facts = [("TaskID", str(self._task_id)), ("reason", f"task {self._task_id}: {text}")]
        return status(0, kind, facts)


def _newest(kept: Mapping[int, Any]) -> dict[int, Any]:
    return dict(list(kept.items())[-MOST:])
