"""MissionCommands without waypoints: a vehicle's mission is over, and the tasks in its plan end undone."""

from __future__ import annotations

from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.spec.records import replace

MISSION = "afrl.cmasi.MissionCommand"
RESPONSE = "afrl.cmasi.AutomationResponse"


def plan_that_ends(envelope: Envelope) -> Envelope | None:
    """A MissionCommand as the AutomationResponse that says the same, if it has no waypoints; None if it has."""
    command: Any = envelope.body
    if command.WaypointList:
        return None
    response = lmcp.new("AutomationResponse", MissionCommandList=[command])
    return replace(envelope, topic=RESPONSE, body=response, raw=None)
