"""The layout of each message's line, as data shared by the writer and the parser.

A line is `TAG,` then fields `label` `value` `,` and a newline; `LAYOUTS` holds, per message, the fields in the order
in which they are sent.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from enum import Enum

from cratous.bridge.text_protocol import messages


class Kind(Enum):
    """How a field's value is encoded."""

    REAL = "%f"
    DEGREES = "%f of a latitude or longitude"
    COUNT = "%d.0"  # the .0 keeps the original's parser from misreading the previous field
    BARE = "%d"  # read with or without .0
    WORD = "one of the words"
    TEXT = "letters, digits and _"


@dataclass(frozen=True)
class FieldLayout:
    """One field: its label on the wire, the message attribute that holds it, and its range."""

    label: str
    attribute: str
    kind: Kind
    words: tuple[str, ...] = ()
    low: int | None = None
    high: str = ""  # the name of the limit in Limits
    optional: bool = False
    first: int = 0  # the number on the wire for 0


@dataclass(frozen=True)
class Layout:
    """One form of a message: COMND and RPRSP have a form for each word of their `type`."""

    tag: str
    direction: messages.Direction
    message: type[messages.Message]
    fields: tuple[FieldLayout, ...]
    form: str = ""
    both: bool = False  # sent in the other direction as well, in our dialect


@dataclass(frozen=True)
class Limits:
    """Largest counts on the wire; the defaults are the sizes of the original's arrays."""

    waypoints: int = 50
    vertices: int = 50
    zones: int = 64
    last_reached: int = 255
    waypoint_index: int = 49


TEXT = re.compile(r"[A-Za-z0-9_]{1,40}")
"""The permitted values of Kind.TEXT."""
ORIGINAL_LIMITS = Limits()
WIDE_LIMITS = Limits(100_000, 100_000, 100_000, 99_999, 99_999)


def _real(label: str, attribute: str, optional: bool = False) -> FieldLayout:
    return FieldLayout(label, attribute, Kind.REAL, optional=optional)


def _deg(label: str, attribute: str, optional: bool = False) -> FieldLayout:
    return FieldLayout(label, attribute, Kind.DEGREES, optional=optional)


def _count(
    label: str,
    attribute: str,
    low: int | None = None,
    high: str = "",
    kind: Kind = Kind.COUNT,
    optional: bool = False,
) -> FieldLayout:
    return FieldLayout(label, attribute, kind, low=low, high=high, optional=optional)


def _word(attribute: str, *words: str) -> FieldLayout:
    return FieldLayout("type", attribute, Kind.WORD, words)


_PLACE = (_deg("lat", "lat_deg"), _deg("long", "long_deg"))
_VELOCITY = (_real("north", "north_mps"), _real("east", "east_mps"), _real("down", "down_mps"))
_REQUEST = _count("request", "request", 0, optional=True)
OURS_ALONE = ("epoch", "request")
"""Labels of optional fields that are not sent to peers of other dialects than ours."""
_DOWN, _UP = messages.Direction.DOWN, messages.Direction.UP

LAYOUTS: tuple[Layout, ...] = (
    Layout(
        "WAYPT",
        _DOWN,
        messages.Waypoint,
        (
            _count("total", "total", 1, "waypoints"),
            _real("speed", "speed_mps"),
            *_PLACE,
            _real("alt", "alt_m"),
            _count("index", "index", 0, "waypoint_index"),
        ),
    ),
    Layout(
        "GEOFN",
        _DOWN,
        messages.FenceVertex,
        (
            _word("fence", "_KEEPIN_", "_KEEPOUT_"),
            _count("totalvert", "total", 1, "vertices"),
            _count("vertIndex", "vertex", 1, "vertices", Kind.BARE),
            *_PLACE,
            _real("floor", "floor_m"),
            _real("ceil", "ceiling_m"),
            _count("index", "zone", 1, "zones"),
        ),
    ),
    Layout(
        "COMND",
        _DOWN,
        messages.FenceDone,
        (_count("id", "zone", 1, "zones", optional=True),),
        "GEOFN_SEND",
    ),
    Layout("COMND", _DOWN, messages.StartMission, (), "START_MISSION"),
    Layout(
        "COMND",
        _DOWN,
        messages.SoftReset,
        (
            _deg("lat", "lat_deg", True),
            _deg("long", "long_deg", True),
            _real("alt", "alt_m", True),
        ),
        "RESET_SFT",
    ),
    Layout("COMND", _DOWN, messages.HardReset, (), "RESET_HRD"),
    Layout("COMND", _DOWN, messages.ForgetFences, (), "FORGET_GEOFN"),
    Layout("COMND", _DOWN, messages.ForgetWaypoints, (), "FORGET_WAYPT"),
    Layout("COMND", _DOWN, messages.StopMission, (), "STOP_MISSION"),
    Layout("COMND", _DOWN, messages.UxasPlans, (), "UXAS_PLANS"),
    Layout("COMND", _DOWN, messages.IcarousPlans, (), "ICAROUS_PLANS"),
    Layout(
        "POSTN",
        _DOWN,
        messages.OwnPosition,
        (
            _real("timegps", "time_s"),
            *_PLACE,
            _real("altabs", "alt_abs_m"),
            _real("altrel", "alt_rel_m"),
            *_VELOCITY,
            _real("hdop", "hdop"),
            _real("vdop", "vdop"),
            _count("numsats", "satellites", 0),
            _count("id", "vehicle_id", 0),
        ),
    ),
    Layout(
        "ATTUD",
        _DOWN,
        messages.Attitude,
        (_real("roll", "roll_deg"), _real("pitch", "pitch_deg"), _real("yaw", "yaw_deg")),
    ),
    Layout(
        "OBJCT",
        _DOWN,
        messages.Traffic,
        (
            _word("what", "_TRAFFIC_", "_OBSTACLE_"),
            *_PLACE,
            _real("alt", "alt_m"),
            *_VELOCITY,
            _count("index", "index", 0),
        ),
    ),
    Layout("WPRCH", _DOWN, messages.WaypointReached, (_count("id", "index", 0, "last_reached"),)),
    Layout(
        "OTHER",
        _DOWN,
        messages.WayOfAnother,
        (
            _count("id", "vehicle_id", 0),
            _count("total", "total", 0, "waypoints"),
            *_PLACE,
            _real("alt", "alt_m"),
            _count("index", "index", 0, "waypoint_index"),
        ),
    ),
    Layout("OVELO", _DOWN, messages.VelocityOfAnother, (_count("id", "vehicle_id", 0), *_VELOCITY)),
    Layout(
        "WPREQ",
        _DOWN,
        messages.RouteRequest,
        (
            _word("planner", "GRID", "ASTAR", "RRT", "SPLINE"),
            _deg("slat", "start_lat_deg"),
            _deg("slong", "start_long_deg"),
            _real("salt", "start_alt_m"),
            _deg("elat", "end_lat_deg"),
            _deg("elong", "end_long_deg"),
            _real("ealt", "end_alt_m"),
            _real("track", "track_deg"),
            _real("vh", "horizontal_mps"),
            _real("vv", "vertical_mps"),
            _REQUEST,
        ),
        both=True,
    ),
    Layout(
        "EPOCH",
        _DOWN,
        messages.EpochTold,
        (_word("owner", "_UXAS_", "_ICAROUS_"), _count("epoch", "epoch", 0)),
    ),
    Layout(
        "SETMOD",
        _UP,
        messages.SetMode,
        (
            _word("mode", "_ACTIVE_", "_PASSIVE_"),
            _count("epoch", "epoch", 0, optional=True),
            _REQUEST,
        ),
    ),
    Layout("SETVEL", _UP, messages.SetVelocity, _VELOCITY),
    Layout("SETPOS", _UP, messages.SetPosition, (*_PLACE, _real("alt", "alt_m"))),
    Layout("GOTOWP", _UP, messages.GoToWaypoint, (_count("id", "index", kind=Kind.BARE),)),
    Layout("RPRSP", _UP, messages.RouteStart, (_REQUEST,), "ST", both=True),
    Layout(
        "RPRSP",
        _UP,
        messages.RoutePoint,
        (*_PLACE, _real("alt", "alt_m"), _real("spd", "speed_mps"), _REQUEST),
        "WP",
        both=True,
    ),
    Layout("RPRSP", _UP, messages.RouteEnd, (_REQUEST,), "ED", both=True),
    Layout(
        "HBEAT", _UP, messages.Heartbeat, (_count("seq", "sequence", 0), _real("time", "time_s"))
    ),
    Layout(
        "AGAIN",
        _UP,
        messages.LinesMissing,
        (
            _word("what", "_WAYPT_", "_GEOFN_"),
            _count("number", "number", 0),
            _count("total", "total", 0),
            _count("first", "first", 0),
            _count("last", "last", 0),
        ),
    ),
    Layout("NOCMD", _UP, messages.NotKnown, (FieldLayout("kind", "kind", Kind.TEXT),)),
    Layout("HELLO", _UP, messages.Hello, (_count("id", "vehicle_id", 0),)),
)

LAYOUT_OF: dict[type[messages.Message], Layout] = {layout.message: layout for layout in LAYOUTS}
assert all(
    {f.attribute for f in layout.fields} == {f.name for f in fields(layout.message)}
    for layout in LAYOUTS
)
