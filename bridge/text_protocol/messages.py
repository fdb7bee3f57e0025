"""The messages of the CRATOUS text protocol, as values.

Angles are degrees, lengths metres, speeds metres per second, times seconds, as on the wire;
`down_mps` is positive downward, always.

Three things are of our own dialect: HELLO (which vehicle a connection speaks for, so that the
order of accepting does not matter), HBEAT (ICAROUS is alive) and `epoch` on SETMOD (the authority
that the sender believes in). Original peers skip unknown fields and unknown tags.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar


class Direction(Enum):
    """Direction of a message: DOWN to ICAROUS, UP to UxAS; DOWN sorts first."""

    DOWN = "UxAS->ICAROUS"
    UP = "ICAROUS->UxAS"


@dataclass(frozen=True)
class Message:
    """Base class of all messages."""

    tag: ClassVar[str] = ""


@dataclass(frozen=True)
class Waypoint(Message):
    """WAYPT: one waypoint of the plan; `index` starts at 0. `total`: the number of all waypoints of the
    plan; from the original a running count."""

    tag: ClassVar[str] = "WAYPT"
    total: int
    speed_mps: float
    lat_deg: float
    long_deg: float
    alt_m: float
    index: int


@dataclass(frozen=True)
class FenceVertex(Message):
    """GEOFN: one vertex of a zone; `vertex` and `zone` start at 1. `fence`: KEEPIN or KEEPOUT."""

    tag: ClassVar[str] = "GEOFN"
    fence: str
    total: int
    vertex: int
    lat_deg: float
    long_deg: float
    floor_m: float
    ceiling_m: float
    zone: int


@dataclass(frozen=True)
class FenceDone(Message):
    """COMND GEOFN_SEND: the zone is complete."""

    tag: ClassVar[str] = "COMND"
    zone: int | None = None


@dataclass(frozen=True)
class StartMission(Message):
    """COMND START_MISSION."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class SoftReset(Message):
    """COMND RESET_SFT: start again from here, with the waypoints that are left."""

    tag: ClassVar[str] = "COMND"
    lat_deg: float | None = None
    long_deg: float | None = None
    alt_m: float | None = None


@dataclass(frozen=True)
class HardReset(Message):
    """COMND RESET_HRD: forget the fences and the count of waypoints."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class ForgetFences(Message):
    """COMND FORGET_GEOFN (our dialect): no zone is in force any more; the plan stays."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class ForgetWaypoints(Message):
    """COMND FORGET_WAYPT (our dialect): there is no plan any more; the zones stay."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class StopMission(Message):
    """COMND STOP_MISSION (our dialect): the mission is over; nothing is flown of it any more until another START_MISSION."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class UxasPlans(Message):
    """COMND UXAS_PLANS (our dialect): UxAS plans live: ICAROUS may ask it for ways by WPREQ."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class IcarousPlans(Message):
    """COMND ICAROUS_PLANS (our dialect): live planning is ICAROUS's own again, as it is without a word."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class OwnPosition(Message):
    """POSTN: position and velocity of the vehicle itself; altitudes above mean sea level."""

    tag: ClassVar[str] = "POSTN"
    time_s: float
    lat_deg: float
    long_deg: float
    alt_abs_m: float
    alt_rel_m: float
    north_mps: float
    east_mps: float
    down_mps: float
    hdop: float = 0.1
    vdop: float = 0.1
    satellites: int = 25
    vehicle_id: int = 0


@dataclass(frozen=True)
class Attitude(Message):
    """ATTUD."""

    tag: ClassVar[str] = "ATTUD"
    roll_deg: float
    pitch_deg: float
    yaw_deg: float


@dataclass(frozen=True)
class Traffic(Message):
    """OBJCT: another aircraft (TRAFFIC) or a thing (OBSTACLE)."""

    tag: ClassVar[str] = "OBJCT"
    what: str
    lat_deg: float
    long_deg: float
    alt_m: float
    north_mps: float
    east_mps: float
    down_mps: float
    index: int


@dataclass(frozen=True)
class WaypointReached(Message):
    """WPRCH: the waypoint with this index (from 0) was just reached."""

    tag: ClassVar[str] = "WPRCH"
    index: int


@dataclass(frozen=True)
class WayOfAnother(Message):
    """OTHER (our dialect): one waypoint of the way that another of UxAS's vehicles flies; `index` starts at 0.
    `total`: the number of all of them; 0, with the index and the place 0 too: it flies no way that is known."""

    tag: ClassVar[str] = "OTHER"
    vehicle_id: int
    total: int
    lat_deg: float
    long_deg: float
    alt_m: float
    index: int


@dataclass(frozen=True)
class VelocityOfAnother(Message):
    """OVELO (our dialect): another of UxAS's vehicles is steered by its ICAROUS, to this velocity."""

    tag: ClassVar[str] = "OVELO"
    vehicle_id: int
    north_mps: float
    east_mps: float
    down_mps: float


@dataclass(frozen=True)
class RouteRequest(Message):
    """WPREQ: plan a route with the planner GRID, ASTAR, RRT or SPLINE. request (our dialect): a number that the
    lines of the answer bear too. In our dialect ICAROUS asks UxAS as well: then UxAS's own planner plans."""

    tag: ClassVar[str] = "WPREQ"
    planner: str
    start_lat_deg: float
    start_long_deg: float
    start_alt_m: float
    end_lat_deg: float
    end_long_deg: float
    end_alt_m: float
    track_deg: float
    horizontal_mps: float
    vertical_mps: float
    request: int | None = None


@dataclass(frozen=True)
class EpochTold(Message):
    """EPOCH (our dialect): to an instance that says a mode of an epoch that is over: who commands its vehicle, UXAS
    or ICAROUS, and the greatest epoch that was given."""

    tag: ClassVar[str] = "EPOCH"
    owner: str
    epoch: int


@dataclass(frozen=True)
class SetMode(Message):
    """SETMOD: ICAROUS takes over (ACTIVE) or hands back (PASSIVE). request (our dialect): it hands back onto UxAS's
    answer to its WPREQ of this number."""

    tag: ClassVar[str] = "SETMOD"
    mode: str
    epoch: int | None = None
    request: int | None = None


@dataclass(frozen=True)
class SetVelocity(Message):
    """SETVEL: fly this velocity; zero north and east mean stay here."""

    tag: ClassVar[str] = "SETVEL"
    north_mps: float
    east_mps: float
    down_mps: float


@dataclass(frozen=True)
class SetPosition(Message):
    """SETPOS: go to this place and stay."""

    tag: ClassVar[str] = "SETPOS"
    lat_deg: float
    long_deg: float
    alt_m: float


@dataclass(frozen=True)
class GoToWaypoint(Message):
    """GOTOWP: go on with this waypoint; from the original the number is noise."""

    tag: ClassVar[str] = "GOTOWP"
    index: int


@dataclass(frozen=True)
class RouteStart(Message):
    """RPRSP ST: a route follows. request: as in `RouteRequest`."""

    tag: ClassVar[str] = "RPRSP"
    request: int | None = None


@dataclass(frozen=True)
class RoutePoint(Message):
    """RPRSP WP: one point of the route; speed 0 means the nominal one."""

    tag: ClassVar[str] = "RPRSP"
    lat_deg: float
    long_deg: float
    alt_m: float
    speed_mps: float
    request: int | None = None


@dataclass(frozen=True)
class RouteEnd(Message):
    """RPRSP ED: the route is complete; one without points says that there is none."""

    tag: ClassVar[str] = "RPRSP"
    request: int | None = None


@dataclass(frozen=True)
class Heartbeat(Message):
    """HBEAT (our dialect): ICAROUS is alive; a sequence number and its virtual time."""

    tag: ClassVar[str] = "HBEAT"
    sequence: int
    time_s: float


@dataclass(frozen=True)
class Hello(Message):
    """HELLO (our dialect): the first message of a client says which vehicle it speaks for."""

    tag: ClassVar[str] = "HELLO"
    vehicle_id: int


@dataclass(frozen=True)
class LinesMissing(Message):
    """AGAIN (our dialect): lines of a plan (WAYPT) or zone (GEOFN) have not come, please again.

    number: of the zone, 0 for the plan; total: its lines, 0 if not known; first, last: the first and last
    that is missing, by index or vertex; last 0 for a zone of which nothing is known: all of it.
    """

    tag: ClassVar[str] = "AGAIN"
    what: str
    number: int
    total: int
    first: int
    last: int


@dataclass(frozen=True)
class NotKnown(Message):
    """NOCMD (our dialect): the answer to a COMND of a kind that ICAROUS does not know.

    kind: as it came, with anything but letters, digits and _ shown as _, of at most 40 characters.
    """

    tag: ClassVar[str] = "NOCMD"
    kind: str
