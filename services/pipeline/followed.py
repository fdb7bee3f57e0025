"""Kinds of tasks that keep to what moves, to each other, or to roads. They follow messages, so `cratous uxas` alone
does them."""

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
"""Full names of types, and those of their services; a WatchTask is one of them where what it watches moves."""
WATCH_SERVICE = "WatchTaskService"
"""The service of a WatchTask; where what it watches stands still, it is a point search."""
