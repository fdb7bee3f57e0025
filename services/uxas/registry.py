"""The services that a configuration may name: their attributes, and constructors.

Services of UxAS that are not implemented here are known by name too, so that they are refused with a reason.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from cratous.bridge.text_protocol.handshake import secret_of_environment
from cratous.services.icarous_communication import service as icarous_communication
from cratous.services.icarous_communication import settings as icarous_settings
from cratous.services.icarous_communication.proposals import Proposals
from cratous.services.icarous_communication.routes import GROUP, PLANNERS, Routes
from cratous.services.loading.uxas_settings import Attr, Entry, choice, flag, number, whole
from cratous.services.logs.message_logger import MessageLogger
from cratous.services.pipeline import (
    aggregator,
    assignment,
    builder,
    loiter,
    planner,
    sensors,
    task_manager,
)
from cratous.services.pipeline.contexts import Contexts
from cratous.services.pipeline.validator import AutomationRequestValidatorService
from cratous.services.uxas import (
    basic_services,
    batch,
    diagram,
    leash,
    regions,
    roads,
    serial_requests,
    steering,
    tracker,
    waypoints,
)
from cratous.services.uxas.daidalus import detection, response
from cratous.services.uxas.daidalus import parameters as daidalus
from cratous.services.uxas.frame import Host
from cratous.services.uxas.message_source import MessageSource

Make = Callable[["Host", Entry, dict[str, Any], str, int], Any]


@dataclass(frozen=True)
class Kind:
    """A service type: attributes, names of child elements, constructor, whether only one instance is allowed.

    plans: it takes part in planning, so the kernels that it uses have to be proved.
    """

    attributes: Mapping[str, Attr]
    make: Make
    children: tuple[str, ...] = ()
    single: bool = False
    plans: bool = False
    ignored: Mapping[str, str] = field(default_factory=dict)


VALIDATOR = "AutomationRequestValidatorService"
ICAROUS = "IcarousCommunicationService"


def contexts_of(host: Host) -> Contexts:
    """The planning contexts of a process; joins the bus when first asked for."""
    if "contexts" not in host.shared:
        host.shared["source"] = MessageSource(host)
        host.shared["contexts"] = Contexts(host.shared["source"])
        host.bus.add(host.shared["contexts"])
    contexts: Contexts = host.shared["contexts"]
    return contexts


def source_of(host: Host) -> MessageSource:
    """The message source shared by the services of a process."""
    contexts_of(host)  # which receives the messages
    source: MessageSource = host.shared["source"]
    return source


def _validator(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return AutomationRequestValidatorService(
        host.shared, contexts_of(host), v["MaxResponseTime_ms"]
    )


def _planner(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    host.shared["separation_m"] = v["MinimumWaypointSeparation_m"]
    host.shared["turn_offset_m"] = v["TurnRadiusOffset_m"]
    _by_icarous(host, entry, "UseThisPlanner", not v["UseThisPlanner"])
    return planner.RoutePlannerVisibilityService(contexts_of(host), v["UseThisPlanner"])


def _by_icarous(host: Host, entry: Entry, name: str, wanted: bool) -> None:
    """Log if routes are left to ICAROUS but no service in this process plans them there."""
    services = [attributes for kind, attributes, _ in host.shared["services"] if kind == ICAROUS]
    if wanted and all(one.get("RoutePlannerUsed", "-1") == "-1" for one in services):
        text = f"{ICAROUS} with a RoutePlannerUsed of 0 to 3 is not in this configuration"
        host.log(
            "WARN", f"{entry.where}: {entry.type}.{name}: routes are planned elsewhere: {text}"
        )


def _aggregator(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    _by_icarous(host, entry, "UseICAROUSRoutePlanner", v["UseICAROUSRoutePlanner"])
    group = GROUP if v["UseICAROUSRoutePlanner"] else ""
    return aggregator.RouteAggregatorService(contexts_of(host), group, v["FastPlan"])


def _assignment(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return assignment.AssignmentTreeBranchBoundService(contexts_of(host))


def _roads(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return roads.made(host, entry, contexts_of(host), v)


def _loiter(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return loiter.LoiterAssignmentService(contexts_of(host))


def _builder(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    host.shared["lead_m"] = v["AssignmentStartPointLead_m"]
    loiter_m = v["DefaultLoiterRadius_m"] if v["AddLoiterToEndOfMission"] else 0.0
    options = builder.Options(v["TurnType"], loiter_m)
    return builder.PlanBuilderService(contexts_of(host), options)


def _task_manager(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    world = source_of(host).world
    return task_manager.TaskManagerService(name, world, host.shared["new_id"])


def _messages(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return basic_services.send_messages(host, entry, v, name)


def _time(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return basic_services.SimulationTime(name, host)


def _hello(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return basic_services.HelloWorld(name, number, v["StringToSend"], v["SendPeriod_ms"], host)


def _report(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    vehicle = host.entity_id if v["VehicleID"] is None else v["VehicleID"]
    return basic_services.StatusReportService(
        name, vehicle, v["ReportPeriod_ms"], v["StaleStateTime_ms"], v["KeepAliveExpiration_ms"]
    )


def _diagram(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    world, folder = source_of(host).world, basic_services.data_of(host, entry)
    return diagram.AutomationDiagramDataService(name, world, folder, host.entity_id)


def _logger(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    folder = basic_services.data_of(host, entry)
    (folder / "SavedMessages").mkdir(parents=True, exist_ok=True)
    return MessageLogger.from_parts(
        entry.attributes, entry.children, folder / "SavedMessages", entry.where, name=name
    )


def _vehicle(host: Host, v: dict[str, Any]) -> int:
    number = v["VehicleID"]
    return host.entity_id if number in (None, -1) else int(number)


def _waypoints(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    if v["NumberWaypointsOverlap"] >= v["NumberWaypointsToServe"]:
        raise entry.refusal(
            "segments that do not go on",
            "NumberWaypointsOverlap",
            f"less than NumberWaypointsToServe = {v['NumberWaypointsToServe']}",
            str(v["NumberWaypointsOverlap"]),
        )
    serving = waypoints.Serving(
        v["NumberWaypointsToServe"],
        v["NumberWaypointsOverlap"],
        v["DefaultLoiterRadius_m"],
        v["AddLoiterToEndOfSegments"],
        v["AddLoiterToEndOfMission"],
        v["LoopBackToFirstTask"],
        v["SetLastWaypointSpeedTo0"],
        v["TurnType"],
        v["GimbalPayloadId"],
    )
    return waypoints.WaypointPlanManagerService(name, _vehicle(host, v), serving)


def _simple(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return waypoints.SimpleWaypointPlanManagerService(name, _vehicle(host, v))


def _sensors(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    world = source_of(host).world
    return sensors.SensorManagerService(
        lambda vehicle: world.get("configuration", vehicle), v["ElevationAngles"] == "radian"
    )


def _region(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return regions.OperatingRegionStateService(v["AdditionalPadding"])


def _leash(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    vehicle = _vehicle(host, v)
    return leash.LoiterLeash(name, contexts_of(host), vehicle, v["LeadDistance"], v["RadiusBuffer"])


def _detection(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    parameters, period_ms = daidalus.parameters_of(entry, v), round(1000 * v["Period_s"])
    return detection.DaidalusDetection(name, _vehicle(host, v), parameters, period_ms)


def _response(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    limit = v["RightOfWayLimit"]
    return response.DaidalusResponse(name, _vehicle(host, v), v["ManeuverType"], limit)


def _icarous(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    given, routes = icarous_settings.settings_of(entry, v), None
    if given.planner in range(len(PLANNERS)):
        contexts = contexts_of(host)
        routes = Routes(name, contexts, given.planner, given.answer_s, given.dialects)
    proposals = Proposals() if given.live else None
    return icarous_communication.IcarousCommunicationService(
        name, host.bus, host.log, given, secret_of_environment(), routes, proposals
    )


def _batch(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return batch.BatchSummaryService(source_of(host))


def _tracker(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return tracker.TaskTrackerService(name, host.log)


def _serial(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return serial_requests.SerialAutomationRequestTestService(name, v["MaxResponseTime_ms"])


def _routes(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return planner.RoutePlannerService(contexts_of(host))


def _steering(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return steering.SteeringService(name, _vehicle(host, v), steering.steering_of(v))


def _pipeline_kind(
    make: Make, attributes: Mapping[str, Attr], ignored: Mapping[str, str] | None = None
) -> Kind:
    return Kind(attributes, make, (), True, True, ignored or {})


_NOT_USED = "it is accepted and not used, as in UxAS, which reads it and does nothing with it"

KINDS: dict[str, Kind] = {
    VALIDATOR: Kind({"MaxResponseTime_ms": whole(5000, 1)}, _validator, single=True, plans=True),
    "TaskManagerService": Kind({}, _task_manager, single=True, plans=True),
    "RoutePlannerVisibilityService": _pipeline_kind(
        _planner,
        {
            "UseThisPlanner": flag(True),
            "TurnRadiusOffset_m": number(0.0, 0.0, 10_000.0),
            "MinimumWaypointSeparation_m": number(50.0),
            "isRoutAggregator": flag(False),
            "OsmFileName": Attr(),
        },
        ignored=dict.fromkeys(("isRoutAggregator", "OsmFileName"), _NOT_USED),
    ),
    "RoutePlannerService": _pipeline_kind(_routes, {}),
    "OsmPlannerService": _pipeline_kind(
        _roads,
        dict.fromkeys(("OsmFile", *roads.WRITTEN), Attr()),
    ),
    "RouteAggregatorService": _pipeline_kind(
        _aggregator,
        {"FastPlan": flag(False), "UseICAROUSRoutePlanner": flag(False)},
    ),
    "AssignmentTreeBranchBoundService": _pipeline_kind(
        _assignment,
        {
            "NumberNodesMaximum": whole(None, -(2**31)),
            "Deadline_ms": whole(None, 1),
            "CostFunction": choice("MINMAX", "MINMAX", "CUMULATIVE"),
            "Semantics": choice("time", "time", "order"),
        },
    ),
    "LoiterAssignmentService": _pipeline_kind(_loiter, {}),
    "PlanBuilderService": _pipeline_kind(
        _builder,
        {
            "AssignmentStartPointLead_m": number(0.0, 0.0, 10_000.0),
            "AddLoiterToEndOfMission": flag(False),
            "DefaultLoiterRadius_m": number(300.0),
            "TurnType": choice("TurnShort", "TurnShort", "FlyOver"),
        },
    ),
    "WaypointPlanManagerService": Kind(
        {
            "VehicleID": whole(-1, -1),
            "NumberWaypointsToServe": whole(100_000, 2),
            "NumberWaypointsOverlap": whole(3, 1),
            "DefaultLoiterRadius_m": number(200.0),
            "AddLoiterToEndOfSegments": flag(False),
            "AddLoiterToEndOfMission": flag(False),
            "LoopBackToFirstTask": flag(False),
            "SetLastWaypointSpeedTo0": flag(False),
            "GimbalPayloadId": whole(-1, -1),
            "TurnType": choice("TurnShort", "TurnShort", "FlyOver"),
            "param.turnType": Attr(),
        },
        _waypoints,
        plans=True,
        ignored={
            "param.turnType": "it is accepted and not used, as in UxAS, which reads TurnType",
        },
    ),
    "SimpleWaypointPlanManagerService": Kind({"VehicleID": whole(-1, -1)}, _simple),
    "SensorManagerService": Kind(
        {"ElevationAngles": choice("degree", "degree", "radian")}, _sensors, single=True
    ),
    "OperatingRegionStateService": Kind(
        {"AdditionalPadding": number(0.0, 0.0, 1e6)}, _region, single=True
    ),
    "LoiterLeash": Kind(
        {"VehicleID": whole(-1, -1), "LeadDistance": number(None), "RadiusBuffer": number(0.0)},
        _leash,
        plans=True,
    ),
    "BatchSummaryService": Kind(
        {"FastPlan": flag(False)}, _batch, single=True, plans=True, ignored={"FastPlan": _NOT_USED}
    ),
    "SteeringService": Kind(steering.ATTRIBUTES, _steering),
    "TaskTrackerService": Kind({}, _tracker),
    "IcarousCommunicationService": Kind(
        icarous_settings.ATTRIBUTES, _icarous, single=True, plans=True
    ),
    "DAIDALUS_WCV_Detection": Kind(
        {**daidalus.ATTRIBUTES, "Period_s": number(0.0, 0.0, 60.0)}, _detection, plans=True
    ),
    "DAIDALUS_WCV_Response": Kind(
        {
            "VehicleID": whole(-1, -1),
            "ManeuverType": choice(
                "Heading", "Heading", "GroundSpeed", "VerticalSpeed", "Altitude"
            ),
            "RightOfWayLimit": number(None),
        },
        _response,
        plans=True,
    ),
    "SerialAutomationRequestTestService": Kind({"MaxResponseTime_ms": whole(300, 1)}, _serial),
    "SendMessagesService": Kind({"PathToMessageFiles": Attr()}, _messages, ("Message",)),
    "AutomationDiagramDataService": Kind({}, _diagram, single=True),
    "MessageLoggerDataService": Kind(
        {
            "LogFileName": Attr(),
            "LogFileMessageCountLimit": whole(0),
            "FilesPerSubDirectory": whole(0),
        },
        _logger,
        ("LogMessage",),
    ),
    "Test_SimulationTime": Kind({}, _time, single=True),
    "HelloWorld": Kind(
        {"StringToSend": Attr(default="Hello World!"), "SendPeriod_ms": whole(1000, 1)}, _hello
    ),
    "StatusReportService": Kind(
        {
            "VehicleID": whole(None),
            "ReportPeriod_ms": whole(5000, 100),
            "StaleStateTime_ms": whole(5000, 10),
            "KeepAliveExpiration_ms": whole(7000, 1000),
        },
        _report,
    ),
}
