"""The services that a configuration may name: their attributes, and how each is made.

What UxAS has and we do not have yet is known by name too, so that it is refused with a sentence.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from cratous.services.message_logger import MessageLogger
from cratous.services.uxas import small
from cratous.services.uxas.frame import Host
from cratous.services.uxas.pipeline import aggregator, assignment, builder, planner, task_manager
from cratous.services.uxas.pipeline.contexts import Contexts
from cratous.services.uxas.pipeline.validator import AutomationRequestValidatorService
from cratous.services.uxas.settings import Attr, Entry, choice, flag, number, whole
from cratous.spec.errors import BadInput

Make = Callable[["Host", Entry, dict[str, Any], str, int], Any]


@dataclass(frozen=True)
class Kind:
    """A service type: attributes, names of child elements, maker, whether only one may be there.

    plans: it takes part in planning, so the kernels that it stands on have to be proved.
    """

    attributes: Mapping[str, Attr]
    make: Make
    children: tuple[str, ...] = ()
    single: bool = False
    plans: bool = False
    ignored: Mapping[str, str] = field(default_factory=dict)


VALIDATOR = "AutomationRequestValidatorService"


def contexts_of(host: Host) -> Contexts:
    """What the messages mean to the services of a process; it joins the bus when first asked for."""
    if "contexts" not in host.shared:
        host.shared["contexts"] = Contexts(host)
        host.bus.add(host.shared["contexts"])
    contexts: Contexts = host.shared["contexts"]
    return contexts


def _validator(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return AutomationRequestValidatorService(host, contexts_of(host), v["MaxResponseTime_ms"])


def _planner(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return planner.RoutePlannerVisibilityService(contexts_of(host))


def _aggregator(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return aggregator.RouteAggregatorService(contexts_of(host))


def _assignment(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return assignment.AssignmentTreeBranchBoundService(contexts_of(host))


def _builder(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    world = contexts_of(host).world
    loiter_m = v["DefaultLoiterRadius_m"] if v["AddLoiterToEndOfMission"] else 0.0
    options = builder.Options(v["TurnType"], loiter_m)
    return builder.PlanBuilderService(lambda vehicle: world.get("state", vehicle), options)


def _task_manager(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    world = contexts_of(host).world
    return task_manager.TaskManagerService(name, world, host.shared["new_id"])


def _messages(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return small.send_messages(host, entry, v, name)


def _time(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return small.SimulationTime(name, host.clock, host.log)


def _hello(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    return small.HelloWorld(name, number, v["StringToSend"], v["SendPeriod_ms"], host)


def _report(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    vehicle = host.entity_id if v["VehicleID"] is None else v["VehicleID"]
    return small.StatusReportService(
        name, vehicle, v["ReportPeriod_ms"], v["StaleStateTime_ms"], v["KeepAliveExpiration_ms"]
    )


def _logger(host: Host, entry: Entry, v: dict[str, Any], name: str, number: int) -> Any:
    folder = host.shared.get("data")
    if folder is None:
        raise BadInput("no folder to write to", where=entry.where, item=entry.type)
    (folder / "SavedMessages").mkdir(parents=True, exist_ok=True)
    return MessageLogger.from_parts(
        entry.attributes, entry.children, folder / "SavedMessages", entry.where, name=name
    )


def _pipeline_kind(
    make: Make, attributes: Mapping[str, Attr], ignored: Mapping[str, str] | None = None
) -> Kind:
    return Kind(attributes, make, (), True, True, ignored or {})


_NOT_USED = "it is accepted and not used: routes and plans follow the mission and the vehicle"

KINDS: dict[str, Kind] = {
    VALIDATOR: Kind({"MaxResponseTime_ms": whole(5000, 1)}, _validator, single=True, plans=True),
    "TaskManagerService": Kind({}, _task_manager, single=True, plans=True),
    "RoutePlannerVisibilityService": _pipeline_kind(
        _planner,
        {
            "TurnRadiusOffset_m": number(0.0),
            "MinimumWaypointSeparation_m": number(50.0),
            "isRoutAggregator": flag(False),
            "OsmFileName": Attr(),
        },
        ignored=dict.fromkeys(
            (
                "TurnRadiusOffset_m",
                "MinimumWaypointSeparation_m",
                "isRoutAggregator",
                "OsmFileName",
            ),
            _NOT_USED,
        ),
    ),
    "RouteAggregatorService": _pipeline_kind(
        _aggregator, {"FastPlan": flag(False)}, ignored={"FastPlan": _NOT_USED}
    ),
    "AssignmentTreeBranchBoundService": _pipeline_kind(
        _assignment,
        {
            "NumberNodesMaximum": whole(0, -(2**31)),
            "CostFunction": choice("MINMAX", "MINMAX", "CUMULATIVE"),
        },
        ignored={
            "NumberNodesMaximum": "the search goes on beyond the first plan, to its own limit"
        },
    ),
    "PlanBuilderService": _pipeline_kind(
        _builder,
        {
            "AssignmentStartPointLead_m": number(50.0),
            "AddLoiterToEndOfMission": flag(False),
            "DefaultLoiterRadius_m": number(300.0),
            "TurnType": choice("TurnShort", "TurnShort", "FlyOver"),
        },
        ignored={"AssignmentStartPointLead_m": _NOT_USED},
    ),
    "SendMessagesService": Kind({"PathToMessageFiles": Attr()}, _messages, ("Message",)),
    "MessageLoggerDataService": Kind(
        {"LogFileMessageCountLimit": whole(0), "FilesPerSubDirectory": whole(0)},
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

NOT_YET = (
    "AutomationDiagramDataService",
    "BatchSummaryService",
    "LoiterLeash",
    "OperatingRegionStateService",
    "OsmPlannerService",
    "RoutePlannerService",
    "SensorManagerService",
    "SerialAutomationRequestTestService",
    "SimpleWaypointPlanManagerService",
    "SteeringService",
    "TaskTrackerService",
    "WaypointPlanManagerService",
)
"""Services of UxAS that we do not have; named in a configuration they are refused."""

TASKS_NOT_YET = (
    "afrl.impact.BlockadeTask",
    "afrl.impact.CommRelayTask",
    "afrl.impact.CordonTask",
    "afrl.impact.EscortTask",
    "afrl.impact.MultiVehicleWatchTask",
    "afrl.impact.WatchTask",
    "uxas.messages.task.AssignmentCoordinatorTask",
    "uxas.messages.task.RendezvousTask",
)
