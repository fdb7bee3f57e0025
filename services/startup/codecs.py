"""Reading and writing functions of the messages of an automation request, made before the first one comes."""

from __future__ import annotations

from cratous.bridge import lmcp
from cratous.bridge.lmcp import binary

MESSAGES = (
    "afrl.cmasi.AutomationRequest", "afrl.cmasi.AutomationResponse", "afrl.cmasi.GimbalStareAction",
    "afrl.cmasi.LoiterAction", "afrl.cmasi.MissionCommand", "afrl.cmasi.ServiceStatus",
    "uxas.messages.route.RoutePlanRequest", "uxas.messages.route.RoutePlanResponse",
    "uxas.messages.route.RouteRequest", "uxas.messages.route.RouteResponse",
    "uxas.messages.task.AssignmentCostMatrix", "uxas.messages.task.SensorFootprintRequests",
    "uxas.messages.task.SensorFootprintResponse", "uxas.messages.task.TaskAssignmentSummary",
    "uxas.messages.task.TaskImplementationRequest",
    "uxas.messages.task.TaskImplementationResponse", "uxas.messages.task.TaskPlanOptions",
    "uxas.messages.task.UniqueAutomationRequest", "uxas.messages.task.UniqueAutomationResponse",
)  # fmt: skip
"""What services send between a request and its mission command."""


def make() -> None:
    """Make these functions: some 12 ms, which the first request would otherwise take longer."""
    binary.prepare(lmcp.types[name] for name in MESSAGES)
