"""Kinds of tasks relative to moving entities, to other vehicles, or to roads. They depend on messages, so
only `cratous uxas` does them.
"""

from __future__ import annotations

WATCH = "afrl.impact.WatchTask"
MANY = "afrl.impact.MultiVehicleWatchTask"
ESCORT = "afrl.impact.EscortTask"
BLOCKADE = "afrl.impact.BlockadeTask"
RELAY = "afrl.impact.CommRelayTask"
RENDEZVOUS = "uxas.messages.task.RendezvousTask"
CORDON = "afrl.impact.CordonTask"
FOLLOWED = {
    MANY: "MultiVehicleWatchTaskService",
    ESCORT: "EscortTaskService",
    BLOCKADE: "BlockadeTaskService",
    RELAY: "CommRelayTaskService",
    RENDEZVOUS: "RendezvousTaskService",
    CORDON: "CordonTaskService",
}
"""Service names by full type name; a WatchTask belongs to them if the watched entity moves."""
WATCH_SERVICE = "WatchTaskService"
"""The service of a WatchTask; one of a stationary entity is a point search."""
