"""AssignmentTreeBranchBoundService on messages: options and costs -> who does what, or why nobody.

Options, their costs and who may fly them come from TaskPlanOptions, the ways from the
AssignmentCostMatrix; vehicles that the request does not name take no part, whatever rows there are.
The search is that of `services.planning`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.services.bus import Envelope
from cratous.services.pipeline.contexts import UNIQUE, Contexts, reasons_of
from cratous.services.pipeline.endings import ENDINGS, newest, request_ended
from cratous.services.pipeline.offers import OPTIONS, Told, read
from cratous.services.planning.assignment_service import (
    AssignmentTreeBranchBoundService as Search,
)
from cratous.services.planning.desk import Inputs, status
from cratous.spec.errors import CratousError

NAME = "AssignmentTreeBranchBoundService"


class _Desk:
    """What the search asks for: the inputs of the one request that it is asked about."""

    def __init__(self) -> None:
        self.found: Inputs | None = None

    def inputs(self, request_id: int) -> Inputs:
        """The inputs of the request in work."""
        assert self.found is not None
        return self.found


class AssignmentTreeBranchBoundService:
    """UniqueAutomationRequest, TaskPlanOptions, AssignmentCostMatrix -> TaskAssignmentSummary."""

    name = NAME
    subscribes: tuple[str, ...] = (
        UNIQUE,
        OPTIONS,
        "uxas.messages.task.AssignmentCostMatrix",
        *ENDINGS,
    )

    def __init__(self, contexts: Contexts) -> None:
        self._contexts, self._desk = contexts, _Desk()
        self._search = Search(self._desk)  # type: ignore[arg-type]

    def start(self) -> dict[int, Told]:
        return {}

    def handle(
        self, state: dict[int, Told], envelope: Envelope, now_ms: int
    ) -> tuple[dict[int, Told], Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            return newest({**state, body.RequestID: Told(body, {})}), ()
        if topic in ENDINGS:
            ended = request_ended(topic, body)
            return {k: v for k, v in state.items() if k != ended}, ()
        key = body.CorrespondingAutomationRequestID
        mine = state.get(key)
        if mine is None:
            return state, ()
        if topic == OPTIONS:
            if body.TaskID in mine.options:
                return state, ()
            told = mine._replace(options={**mine.options, body.TaskID: body})
            return {**state, key: told}, ()
        left = {k: v for k, v in state.items() if k != key}
        try:
            return left, self._assign(mine, envelope, now_ms)
        except CratousError as error:
            return left, [status(key, "Error", [("reason", text) for text in reasons_of(error)])]

    def _assign(self, mine: Told, envelope: Envelope, now_ms: int) -> list[Any]:
        context, out = self._contexts.of(mine.request.RequestID), []
        offered = read(mine, envelope.body, context)
        if offered.foreign:
            text = f"{offered.foreign} rows are of vehicles that the request does not name: they take no part"
            out.append(status(mine.request.RequestID, "Warning", [("reason", text)]))
        self._desk.found = offered.inputs
        asked = envelope.body.copy(CostMatrix=offered.rows)
        body = Envelope(envelope.seq, envelope.time_ms, envelope.source, envelope.topic, asked)
        _, found = self._search.handle(self._search.start(), body, now_ms)
        reached = {row.DestinationTaskID for row in offered.rows}
        why = [
            f"the costs have no way to task {task}" for task in offered.tasks if task not in reached
        ]
        return [*out, *(_explained(body, why) for body in found)]


def _explained(body: Any, why: list[str]) -> Any:
    """An error with what the messages show besides the search's own reasons."""
    if type(body).__name__ != "ServiceStatus" or body.StatusType.name != "Error" or not why:
        return body
    more = status(0, "Error", [("reason", text) for text in why]).Info[1:]
    return body.copy(Info=[*body.Info, *more])
