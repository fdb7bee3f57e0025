"""The three kinds of automation requests, and their responses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.pipeline.status import status

_INFO = 8  # most entries of AutomationResponse.Info


class Asked(NamedTuple):
    """A request as received: its message, the AutomationRequest inside, whether it is only a trial, its
    planning states, its number on the bus, and its own RequestID, 0 for none.
    """

    body: Any
    request: Any
    sandbox: bool
    states: list[Any]
    seq: int
    number: int = 0


def asked_of(topic: str, body: Any, seq: int) -> Asked:
    """Normalise a request of any of the three kinds."""
    if topic.endswith(".ImpactAutomationRequest"):
        return Asked(body, body.TrialRequest, body.Sandbox, [], seq)
    if topic.endswith(".TaskAutomationRequest"):
        states = list(body.PlanningStates)
        return Asked(body, body.OriginalRequest, body.SandBoxRequest, states, seq, body.RequestID)
    return Asked(body, body, False, [], seq)


def _wrapped(asked: Asked, response: Any, finals: Sequence[Any]) -> Any:
    kind, body = type(asked.body).__name__, asked.body
    if kind == "ImpactAutomationRequest":
        return lmcp.new(
            "ImpactAutomationResponse",
            ResponseID=body.RequestID,
            TrialResponse=response,
            PlayID=body.PlayID,
            SolutionID=body.SolutionID,
            Sandbox=body.Sandbox,
        )
    if kind == "TaskAutomationRequest":
        return lmcp.new(
            "TaskAutomationResponse",
            ResponseID=body.RequestID,
            OriginalResponse=response,
            FinalStates=list(finals),
        )
    return response


def answer(asked: Asked, unique: Any, notes: Sequence[str]) -> Any:
    """The response to a request from the pipeline's UniqueAutomationResponse; notes become Info."""
    response = unique.OriginalResponse
    if response is None:
        response = lmcp.new("AutomationResponse")
    if notes:
        told = [lmcp.new("KeyValuePair", Key="warning", Value=text) for text in notes]
        response = response.copy(Info=[*response.Info, *told][:_INFO])
    return _wrapped(asked, response, unique.FinalStates)


def refusal(asked: Asked, number: int, reasons: Sequence[str]) -> list[Any]:
    """A ServiceStatus of type Error, and a response without commands that carries the reasons."""
    pairs = [lmcp.new("KeyValuePair", Key="reason", Value=text) for text in reasons]
    empty = lmcp.new("AutomationResponse", Info=pairs[:_INFO])
    told = status(number, "Error", [("reason", text) for text in reasons])
    return [told, _wrapped(asked, empty, ())]
