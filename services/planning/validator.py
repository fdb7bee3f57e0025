"""AutomationRequestValidatorService: gives requests their ids and lets only sound ones pass."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.frames import compass
from cratous.services.planning.desk import Desk, Inputs, status


class Waiting(NamedTuple):
    """Requests passed so far, and those without an answer yet."""

    passed: int = 0
    open: tuple[int, ...] = ()


class AutomationRequestValidatorService:
    """AutomationRequest -> UniqueAutomationRequest; UniqueAutomationResponse -> AutomationResponse.

    A request that names a vehicle or task that the mission does not have gets an error status.
    """

    name = "AutomationRequestValidatorService"
    subscribes: tuple[str, ...] = (
        "afrl.cmasi.AutomationRequest",
        "uxas.messages.task.UniqueAutomationResponse",
    )

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> Waiting:
        return Waiting()

    def handle(
        self, state: Waiting, envelope: Envelope, now_ms: int
    ) -> tuple[Waiting, Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "uxas.messages.task.UniqueAutomationResponse":
            left = tuple(r for r in state.open if r != body.ResponseID)
            return state._replace(open=left), [body.OriginalResponse]
        if envelope.topic != "afrl.cmasi.AutomationRequest":
            return state, ()
        request_id = state.passed + 1
        if request_id > len(self._desk.requests):
            return state, [status(request_id, "Error", [("reason", "the request is not prepared")])]
        inputs = self._desk.inputs(request_id)
        wrong = [f"vehicle {v} does not exist" for v in body.EntityList if v not in inputs.starts]
        known = {task.id for task in inputs.mission.tasks}
        wrong += [f"task {t} does not exist" for t in body.TaskList if t not in known]
        state = Waiting(request_id, state.open)
        if wrong:
            return state, [status(request_id, "Error", [("reason", text) for text in wrong])]
        unique = lmcp.new(
            "UniqueAutomationRequest",
            RequestID=request_id,
            OriginalRequest=body,
            PlanningStates=planning_states(self._desk, inputs, body.EntityList),
        )
        return state._replace(open=(*state.open, request_id)), [unique]


def planning_states(desk: Desk, inputs: Inputs, vehicles: Iterable[int]) -> list[Any]:
    """Where each of the vehicles plans from."""
    return [
        lmcp.new(
            "PlanningState",
            EntityID=vehicle,
            PlanningPosition=desk.location(inputs.starts[vehicle]),
            PlanningHeading=compass(inputs.starts[vehicle].heading_rad),
        )
        for vehicle in vehicles
    ]
