"""A mission as a UxAS configuration and the messages that it sends."""

from __future__ import annotations

from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

from cratous.bridge.lmcp.xml_writing import dumps
from cratous.services.exporting.messages import Told
from cratous.services.loading.lost_link_attributes import CHOICES
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Mission
from cratous.spec.mission.bridge_times import USUAL

CONFIGURATION, MESSAGES = "cfg.xml", "messages.xml"
ENTITY = 100
TURN = {"TurnType": "FlyOver"}
"""Waypoints are flown over: a turn started early would end a task before its end is reached."""


def messages_text(told: Told) -> str:
    """All messages sent to UxAS, in order."""
    bodies = "".join(dumps(body) for body in told.all())
    return f"<Messages>\n{bodies}</Messages>\n"


def configuration_text(
    mission: Mission,
    instances: Sequence[int],
    communication: dict[str, str] | None = None,
    bridges: str = "",
    first: Sequence[str] = (),
) -> str:
    """The configuration: planning services, one waypoint manager per vehicle, ICAROUS.

    communication: further attributes of the service for the ICAROUS instances; bridges: as XML;
    first: services before the others.
    """
    search = {"CostFunction": mission.cost, "Semantics": mission.order}
    if mission.node_limit is not None:
        search["NumberNodesMaximum"] = str(mission.node_limit)
    services = [
        *(service_text(kind) for kind in first),
        service_text("TaskManagerService"),
        service_text("AutomationRequestValidatorService"),
        service_text("RouteAggregatorService"),
        service_text("RoutePlannerVisibilityService"),
        service_text("AssignmentTreeBranchBoundService", search),
        service_text("PlanBuilderService", TURN),
        *(
            service_text("WaypointPlanManagerService", {"VehicleID": str(vehicle.id), **TURN})
            for vehicle in mission.vehicles
        ),
    ]
    if instances:
        asked = {
            "NumberOfUAVs": str(len(instances)),
            "VehicleIDs": " ".join(map(str, instances)),
            **lost_link_of(mission),
            **(communication or {}),
        }
        services.append(service_text("IcarousCommunicationService", asked))
    sent = f'    <Message MessageFileName="{MESSAGES}" SendTime_ms="0"/>\n'
    return (
        f'<UxAS FormatVersion="1.0" EntityID="{ENTITY}" EntityType="Aircraft" '
        'ConsoleLoggerSeverityLevel="INFO">\n'
        + bridges
        + "".join(services)
        + f'  <Service Type="SendMessagesService" PathToMessageFiles=".">\n{sent}  </Service>\n'
        "</UxAS>\n"
    )


def lost_link_of(mission: Mission) -> dict[str, str]:
    """What a mission flies without the link, as attributes of the service for the ICAROUS instances; {} for a choice
    that they do not have.
    """
    loss = mission.link_loss
    if loss is None:
        times = mission.bridge_times
        after_s = f"{times.lost_link_after_ms / 1000:.10g}"
        return {} if times == USUAL else {"LostLinkAfter_s": after_s}
    if loss.choice.value not in CHOICES:
        return {}
    said = {"LostLink": loss.choice.value, "LostLinkAfter_s": f"{loss.after_ms / 1000:.10g}"}
    if loss.to is not None:
        place = Projection(mission.frame).to_geodetic(loss.to.north_m, loss.to.east_m)
        said["LostLinkTo"] = f"{place[0]:.9f} {place[1]:.9f} {loss.to.alt_m:.3f}"
    return said


def service_text(kind: str, attributes: dict[str, str] | None = None) -> str:
    """The configuration entry of a service."""
    said = "".join(f" {name}={quoteattr(value)}" for name, value in (attributes or {}).items())
    return f'  <Service Type="{kind}"{said}/>\n'
