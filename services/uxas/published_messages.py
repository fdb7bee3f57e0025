"""Class and published messages of each registered service, for the table of services and its tests."""

from __future__ import annotations

from cratous.services.icarous_communication import service as icarous_communication
from cratous.services.logs.message_logger import MessageLogger
from cratous.services.pipeline import (
    aggregator,
    assignment,
    builder,
    loiter,
    planner,
    sensors,
    task_manager,
    tasks,
)
from cratous.services.pipeline.validator import AutomationRequestValidatorService
from cratous.services.roads.service import ROADS, OsmPlannerService
from cratous.services.uxas import (
    basic_services,
    batch,
    diagram,
    leash,
    regions,
    serial_requests,
    steering,
    tracker,
    waypoints,
)
from cratous.services.uxas.daidalus import detection, response
from cratous.services.uxas.registry import VALIDATOR

SERVES: dict[str, tuple[type, tuple[str, ...]]] = {
    VALIDATOR: (
        AutomationRequestValidatorService,
        ("UniqueAutomationRequest", "AutomationResponse", "ImpactAutomationResponse",
         "TaskAutomationResponse", "ServiceStatus"),
    ),
    "TaskManagerService": (
        task_manager.TaskManagerService, ("CreateNewService", "KillService")
    ),
    "Task services": (
        tasks.TaskService,
        ("TaskInitialized", "SensorFootprintRequests", "TaskPlanOptions", "RoutePlanRequest",
         "TaskImplementationResponse", "TaskActive", "TaskComplete", "VehicleActionCommand",
         "ServiceStatus", "AssignmentCoordination", "TaskAutomationRequest"),
    ),
    "RoutePlannerVisibilityService": (
        planner.RoutePlannerVisibilityService, ("RoutePlanResponse",)
    ),
    "RoutePlannerService": (planner.RoutePlannerService, ("RoutePlanResponse",)),
    ROADS: (
        OsmPlannerService,
        ("RoutePlanResponse", "EgressRouteResponse", "RoadPointsResponse", "ServiceStatus"),
    ),
    "RouteAggregatorService": (
        aggregator.RouteAggregatorService,
        ("RoutePlanRequest", "AssignmentCostMatrix", "RouteResponse"),
    ),
    "AssignmentTreeBranchBoundService": (
        assignment.AssignmentTreeBranchBoundService, ("TaskAssignmentSummary", "ServiceStatus")
    ),
    "LoiterAssignmentService": (
        loiter.LoiterAssignmentService, ("VehicleActionCommand", "ServiceStatus")
    ),
    "PlanBuilderService": (
        builder.PlanBuilderService,
        ("TaskImplementationRequest", "UniqueAutomationResponse", "ServiceStatus"),
    ),
    "WaypointPlanManagerService": (
        waypoints.WaypointPlanManagerService, ("MissionCommand", "VehicleActionCommand"),
    ),
    "SimpleWaypointPlanManagerService": (
        waypoints.SimpleWaypointPlanManagerService, ("MissionCommand",)
    ),
    "SensorManagerService": (
        sensors.SensorManagerService, ("SensorFootprintResponse", "ServiceStatus")
    ),
    "OperatingRegionStateService": (
        regions.OperatingRegionStateService, ("OperatingRegion",)
    ),
    "LoiterLeash": (leash.LoiterLeash, ("RoutePlanRequest", "VehicleActionCommand", "ServiceStatus")),
    "BatchSummaryService": (
        batch.BatchSummaryService, ("TaskAutomationRequest", "BatchSummaryResponse")
    ),
    "SteeringService": (
        steering.SteeringService, ("VehicleActionCommand", "SafeHeadingAction", "AirVehicleState")
    ),
    "TaskTrackerService": (tracker.TaskTrackerService, ()),
    "IcarousCommunicationService": (
        icarous_communication.IcarousCommunicationService,
        ("MissionCommand", "VehicleActionCommand", "TaskPause", "TaskResume", "ServiceStatus",
         "OwnRoutePlanner", "RoutePlanResponse", "BridgeStatus", "Heartbeat", "GateState",
         "GatedCommand", "AuthorityChange", "ModeRefused", "LinkLossState"),
    ),
    "DAIDALUS_WCV_Detection": (
        detection.DaidalusDetection,
        ("DAIDALUSConfiguration", "WellClearViolationIntervals", "ServiceStatus"),
    ),
    "DAIDALUS_WCV_Response": (
        response.DaidalusResponse, ("VehicleActionCommand", "MissionCommand", "ServiceStatus")
    ),
    "AutomationDiagramDataService": (diagram.AutomationDiagramDataService, ("ServiceStatus",)),
    "SerialAutomationRequestTestService": (
        serial_requests.SerialAutomationRequestTestService,
        ("AutomationRequest", "ImpactAutomationRequest"),
    ),
    "SendMessagesService": (basic_services.SendMessagesService, ()),
    "MessageLoggerDataService": (MessageLogger, ()),
    "Test_SimulationTime": (basic_services.SimulationTime, ()),
    "HelloWorld": (basic_services.HelloWorld, ("KeyValuePair",)),
    "StatusReportService": (basic_services.StatusReportService, ("OnboardStatusReport",)),
}  # fmt: skip
"""For each service its class, which defines its subscriptions, and the messages that it publishes."""
