"""The CRATOUS text protocol, both directions: messages, lines, streaming parser, handshake."""

from __future__ import annotations

from cratous.bridge.text_protocol.format import direction_of, encode
from cratous.bridge.text_protocol.layouts import (
    ORIGINAL_LIMITS,
    WIDE_LIMITS,
    Limits,
)
from cratous.bridge.text_protocol.messages import (
    Attitude,
    Direction,
    FenceDone,
    FenceVertex,
    GoToWaypoint,
    HardReset,
    Heartbeat,
    Hello,
    Message,
    OwnPosition,
    RouteEnd,
    RoutePoint,
    RouteRequest,
    RouteStart,
    SetMode,
    SetPosition,
    SetVelocity,
    SoftReset,
    StartMission,
    Traffic,
    Waypoint,
    WaypointReached,
)
from cratous.bridge.text_protocol.parser import Record, Skipped, StreamParser, WireError

__all__ = [
    "ORIGINAL_LIMITS",
    "WIDE_LIMITS",
    "Attitude",
    "Direction",
    "FenceDone",
    "FenceVertex",
    "GoToWaypoint",
    "HardReset",
    "Heartbeat",
    "Hello",
    "Limits",
    "Message",
    "OwnPosition",
    "Record",
    "RouteEnd",
    "RoutePoint",
    "RouteRequest",
    "RouteStart",
    "SetMode",
    "SetPosition",
    "SetVelocity",
    "Skipped",
    "SoftReset",
    "StartMission",
    "StreamParser",
    "Traffic",
    "Waypoint",
    "WaypointReached",
    "WireError",
    "direction_of",
    "encode",
]
