"""What the services of the pipeline tell each other, as the tests make it."""

from __future__ import annotations

from typing import Any

from pipeline_tools import place, request

from cratous.bridge import lmcp

STEPS = (
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "RoutePlanRequest",
    "RoutePlanResponse",
    "AssignmentCostMatrix",
    "TaskAssignmentSummary",
    "TaskImplementationRequest",
    "TaskImplementationResponse",
    "UniqueAutomationResponse",
)
"""What is told on the way from a request to its answer, in this order."""


def unique(number: int, *tasks: int, vehicles: tuple[int, ...] = (1,), **more: Any) -> Any:
    original = request(*tasks, vehicles=vehicles, **more)
    return lmcp.new("UniqueAutomationRequest", RequestID=number, OriginalRequest=original)


def option(task: int, number: int, *vehicles: int, latitude: float = 0.02, cost: int = 1000) -> Any:
    return lmcp.new(
        "TaskOption",
        TaskID=task,
        OptionID=number,
        EligibleEntities=list(vehicles),
        Cost=cost,
        StartLocation=place(latitude),
        EndLocation=place(latitude + 0.002),
    )


def options(number: int, task: int, *made: Any, composition: str = "") -> Any:
    text = composition or "+(" + " ".join(f"p{o.OptionID}" for o in made) + ")"
    return lmcp.new(
        "TaskPlanOptions",
        CorrespondingAutomationRequestID=number,
        TaskID=task,
        Composition=text if made or composition else "",
        Options=list(made),
    )


def planned(asked: Any, cost: int = 7, missing: tuple[int, ...] = ()) -> Any:
    """A planner's answer to a RoutePlanRequest: `cost` for each, none for some."""
    plans = [
        lmcp.new("RoutePlan", RouteID=c.RouteID, RouteCost=-1 if c.RouteID in missing else cost)
        for c in asked.RouteRequests
    ]
    return lmcp.new(
        "RoutePlanResponse",
        ResponseID=asked.RequestID,
        VehicleID=asked.VehicleID,
        RouteResponses=plans,
    )


def implementation(asked: Any, points: list[Any], **more: Any) -> Any:
    """A task's answer to a TaskImplementationRequest."""
    names = ("CorrespondingAutomationRequestID", "TaskID", "OptionID", "VehicleID")
    said_back = {name: getattr(asked, name) for name in names}
    answer = {"ResponseID": asked.RequestID, "TaskWaypoints": points, **said_back, **more}
    return lmcp.new("TaskImplementationResponse", **answer)


def ended(number: int) -> Any:
    """An error that ends a request."""
    info = [lmcp.new("KeyValuePair", Key="RequestID", Value=str(number))]
    return lmcp.new("ServiceStatus", StatusType="Error", Info=info)


def cost(
    vehicle_id: int, task: int, number: int, time: int, start: tuple[int, int] = (0, 0)
) -> Any:
    return lmcp.new(
        "TaskOptionCost",
        VehicleID=vehicle_id,
        IntialTaskID=start[0],
        IntialTaskOption=start[1],
        DestinationTaskID=task,
        DestinationTaskOption=number,
        TimeToGo=time,
    )


def matrix(number: int, *rows: Any) -> Any:
    return lmcp.new(
        "AssignmentCostMatrix", CorrespondingAutomationRequestID=number, CostMatrix=list(rows)
    )


def mission(count: int, back_to: int = 0, first: int = 1, vehicle_id: int = 1) -> Any:
    """Waypoints 1 to count in a row, the last one leads to `back_to` (0: to itself)."""
    points = [
        lmcp.new(
            "Waypoint",
            Number=n,
            NextWaypoint=n + 1 if n < count else back_to or n,
            Speed=20.0,
            Latitude=0.01 * n,
            AssociatedTasks=[9] if n > 2 else [],
        )
        for n in range(1, count + 1)
    ]
    return lmcp.new(
        "MissionCommand", VehicleID=vehicle_id, WaypointList=points, FirstWaypoint=first
    )


def response(*commands: Any) -> Any:
    return lmcp.new("AutomationResponse", MissionCommandList=list(commands))
