"""The messages of the CRATOUS text protocol, as values.

Angles are in degrees, lengths in metres, speeds in metres per second, times in seconds, as on the wire; `down_mps` is
always positive downward.

Additions of our own dialect: HELLO (which vehicle a connection speaks for, so that the order of accepting does not
matter), HBEAT (ICAROUS is alive), `epoch` on SETMOD (the authority that the sender assumes), and what is marked
below. Original peers skip unknown fields and unknown tags.
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
    """WAYPT: one waypoint of the plan; `index` starts at 0. `total`: the number of waypoints of the plan; from the
    original a running count."""

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
    """COMND RESET_SFT: restart from here, with the remaining waypoints."""

    tag: ClassVar[str] = "COMND"
    lat_deg: float | None = None
    long_deg: float | None = None
    alt_m: float | None = None


@dataclass(frozen=True)
class HardReset(Message):
    """COMND RESET_HRD: discard the zones and the count of waypoints."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class ForgetFences(Message):
    """COMND FORGET_GEOFN (our dialect): no zone is in force any longer; the plan stays."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class ForgetWaypoints(Message):
    """COMND FORGET_WAYPT (our dialect): there is no plan any longer; the zones stay."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class StopMission(Message):
    """COMND STOP_MISSION (our dialect): the mission is over and is not flown until another START_MISSION."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class UxasPlans(Message):
    """COMND UXAS_PLANS (our dialect): UxAS plans in flight: ICAROUS may ask it for routes by WPREQ."""

    tag: ClassVar[str] = "COMND"


@dataclass(frozen=True)
class IcarousPlans(Message):
    """COMND ICAROUS_PLANS (our dialect): ICAROUS plans in flight again, which is the default."""

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
    """ATTUD: attitude of the vehicle."""

    tag: ClassVar[str] = "ATTUD"
    roll_deg: float
    pitch_deg: float
    yaw_deg: float


@dataclass(frozen=True)
class Traffic(Message):
    """OBJCT: another aircraft (TRAFFIC) or an object (OBSTACLE)."""

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
    """OTHER (our dialect): one waypoint of the route flown by another of UxAS's vehicles; `index` starts at 0.
    `total`: their number; 0, with index and position 0 too: no route of it is known."""

    tag: ClassVar[str] = "OTHER"
    vehicle_id: int
    total: int
    lat_deg: float
    long_deg: float
    alt_m: float
    index: int


@dataclass(frozen=True)
class VelocityOfAnother(Message):
    """OVELO (our dialect): another of UxAS's vehicles is steered by its ICAROUS, at this velocity."""

    tag: ClassVar[str] = "OVELO"
    vehicle_id: int
    north_mps: float
    east_mps: float
    down_mps: float


@dataclass(frozen=True)
class RouteRequest(Message):
    """WPREQ: plan a route with the planner GRID, ASTAR, RRT or SPLINE. request (our dialect): a number that the lines
    of the answer repeat. In our dialect ICAROUS may ask UxAS too, whose own planner then plans."""

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
    """EPOCH (our dialect): to an instance that sends a mode of a past epoch: who commands its vehicle, UXAS or
    ICAROUS, and the latest epoch."""

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
    """SETVEL: fly this velocity; zero north and east means stay here."""

    tag: ClassVar[str] = "SETVEL"
    north_mps: float
    east_mps: float
    down_mps: float


@dataclass(frozen=True)
class SetPosition(Message):
    """SETPOS: fly to this position and stay."""

    tag: ClassVar[str] = "SETPOS"
    lat_deg: float
    long_deg: float
    alt_m: float


@dataclass(frozen=True)
class GoToWaypoint(Message):
    """GOTOWP: continue with this waypoint; from the original the number is meaningless."""

    tag: ClassVar[str] = "GOTOWP"
    index: int


@dataclass(frozen=True)
class RouteStart(Message):
    """RPRSP ST: a route follows. request: as in `RouteRequest`."""

    tag: ClassVar[str] = "RPRSP"
    request: int | None = None


@dataclass(frozen=True)
class RoutePoint(Message):
    """RPRSP WP: one point of the route; speed 0 means the nominal speed."""

    tag: ClassVar[str] = "RPRSP"
    lat_deg: float
    long_deg: float
    alt_m: float
    speed_mps: float
    request: int | None = None


@dataclass(frozen=True)
class RouteEnd(Message):
    """RPRSP ED: the route is complete; a response without points means that there is no route."""

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
    """AGAIN (our dialect): lines of a plan (WAYPT) or zone (GEOFN) are missing and requested again.

    number: of the zone, 0 for the plan; total: number of its lines, 0 if not known; first, last: the first and last
    missing one, by index or vertex; last 0 for a zone of which nothing is known: all of it.
    """

    tag: ClassVar[str] = "AGAIN"
    what: str
    number: int
    total: int
    first: int
    last: int


@dataclass(frozen=True)
class NotKnown(Message):
    """NOCMD (our dialect): the answer to a COMND of a type that ICAROUS does not know.

    kind: the type as received, with characters other than letters, digits and _ replaced by _, at most 40 characters.
    """

    tag: ClassVar[str] = "NOCMD"
    kind: str
