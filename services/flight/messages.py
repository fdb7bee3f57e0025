"""The messages between the actors of a flight: plain values, times in ms of virtual time.

Each message has one receiver: the UxAS end of the bridge, the executive, a vehicle, a planner, the wire, or (`Say`)
everybody on the bus."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.bridge.link import LinkEvent
from cratous.bridge.text_protocol import Message
from cratous.core.authority.gate import Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight.dynamics import AirState, Limits
from cratous.services.icarous.messages import Fails, Offers, Sensed, Uncertified, Wish, WithoutLink
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Plan, Pose


class Say(NamedTuple):
    """To the bus: publish a message body on behalf of a sender."""

    body: Any
    source: str


class Down(NamedTuple):
    """To the wire: lines for a vehicle's ICAROUS, in order."""

    vehicle_id: int
    lines: tuple[Message, ...]


# to the UxAS end of the bridge ------------------------------------------------------------------


class Connected(NamedTuple):
    """The connections to these vehicles' ICAROUS instances are established, for the first time or again."""

    now_ms: int
    vehicle_ids: tuple[int, ...]


class ZonesKnown(NamedTuple):
    """All zones in force from now on. Unless they extend those sent before, in the same order, the instances are
    reset and sent everything again."""

    zones: tuple[Zone, ...]


class Route(NamedTuple):
    """The route ahead of a vehicle. speed_m_s: planned speed; from_m: arc length of its first point on the vehicle's
    track [m]."""

    vehicle_id: int
    points: tuple[Position, ...]
    speed_m_s: float
    from_m: float


class Flown(NamedTuple):
    """Arc length that a vehicle has flown on its track [m]."""

    vehicle_id: int
    s_m: float


class Left(NamedTuple):
    """Where a vehicle has left the path of its task; in transit, where that task begins."""

    vehicle_id: int
    position: Position


class Stop(NamedTuple):
    """A vehicle's mission is over."""

    vehicle_id: int


class Beat(NamedTuple):
    """A heartbeat is due. aircraft: the states of all aircraft, sorted by id."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class Seen(NamedTuple):
    """The state of one vehicle has been received. time_ms: the state's own time; aircraft: as in `Beat`, at that
    time; roll_rad, pitch_rad: attitude of the vehicle."""

    vehicle_id: int
    now_ms: int
    time_ms: int
    aircraft: tuple[tuple[int, AirState], ...]
    roll_rad: float
    pitch_rad: float


class Heard(NamedTuple):
    """A line has been received from a vehicle's ICAROUS."""

    vehicle_id: int
    now_ms: int
    line: Message


class Unreadable(NamedTuple):
    """An unreadable line has been received. text: the line, its sender and the reason."""

    vehicle_id: int
    now_ms: int
    text: str


class Lost(NamedTuple):
    """A vehicle's connection has been closed."""

    vehicle_id: int
    now_ms: int
    event: LinkEvent


class GateIs(NamedTuple):
    """The vehicle reports a change of its gate."""

    vehicle_id: int
    gate: Gate


class Watch(NamedTuple):
    """Check for instances that have become silent. of: vehicles to check, None for all."""

    now_ms: int
    of: frozenset[int] | None = None


# to the executive -------------------------------------------------------------------------------


class Begin(NamedTuple):
    """The mission begins. aircraft: the states of its vehicles, by id."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class SetOut(NamedTuple):
    """All instances are connected: send the first routes and command the first tracks."""


class Tick(NamedTuple):
    """A step of the flight. aircraft: as in `Begin`."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class Planned(NamedTuple):
    """The requested plan."""

    plan: Plan


class NotPlanned(NamedTuple):
    """No plan satisfies the request. why: the reasons, in words; of: the reasons per task, where known."""

    why: str
    of: tuple[tuple[int, str], ...] = ()


class Report(NamedTuple):
    """A heartbeat is due: report where the cameras point and how far each vehicle is along its path."""

    now_ms: int


class Closing(NamedTuple):
    """A step is over: check whether the flight has ended. gates: by vehicle id; circling: vehicles that fly a
    permitted circle because UxAS is not heard.
    """

    now_ms: int
    gates: tuple[tuple[int, Gate], ...]
    circling: tuple[int, ...] = ()


class Suspend(NamedTuple):
    """ICAROUS has a vehicle. act: result of the kernel `link_mode`."""

    vehicle_id: int
    now_ms: int
    act: int


class Because(NamedTuple):
    """The vehicle reports its ICAROUS's request to the gate (act: as in `Wish`), and the reason."""

    vehicle_id: int
    act: int
    reason: str
    intruder_id: int


class TakeBack(NamedTuple):
    """A vehicle is offered back; commands of this epoch take it. act: as in `Suspend`."""

    vehicle_id: int
    now_ms: int
    act: int
    epoch: int


class NotHeard(NamedTuple):
    """A vehicle's ICAROUS is no longer heard. Sent only if the mission sets the behaviour without the link."""

    vehicle_id: int
    now_ms: int


class Stands(NamedTuple):
    """A vehicle has stopped on the ground and stays there. site: the landing site on which it stands, "" if on none."""

    vehicle_id: int
    site: str


class HeardAgain(NamedTuple):
    """The instance is heard again. by_uxas: UxAS has the vehicle, according to its gate."""

    vehicle_id: int
    now_ms: int
    by_uxas: bool


# from the executive -----------------------------------------------------------------------------


class AskPlan(NamedTuple):
    """To the planner: request a plan for the remaining tasks.

    known: the mission as known now; starts: pose of each vehicle; done: completed tasks, with start and end [ms];
    absent: vehicles that take no part, with the reason; undone: tasks given up, with the reason; begun: tasks that
    have begun and not ended."""

    now_ms: int
    known: Mission
    starts: tuple[tuple[int, Pose], ...]
    done: tuple[tuple[int, int, int], ...]
    absent: tuple[tuple[int, str], ...]
    undone: tuple[tuple[int, str], ...]
    begun: tuple[int, ...]


class Over(NamedTuple):
    """To the clock: the flight has ended. outcome: in one word."""

    outcome: str


class RouteAsked(NamedTuple):
    """To the executive: the ICAROUS that has a vehicle requests a route from `start` to `end`. number: of the
    request."""

    vehicle_id: int
    start: AirState
    end: Position
    number: int


class Proposed(NamedTuple):
    """The answer to `RouteAsked`: the points of a route, empty if there is none. speed_m_s: planned speed."""

    vehicle_id: int
    number: int
    way: tuple[Position, ...]
    speed_m_s: float


ToLinkEnd = (
    Connected
    | ZonesKnown
    | Route
    | Flown
    | Left
    | Stop
    | Beat
    | Seen
    | Heard
    | Unreadable
    | Lost
    | GateIs
    | Watch
    | Proposed
)
FromLinkEnd = Say | Down | Suspend | TakeBack | RouteAsked | NotHeard | HeardAgain


# to a vehicle -----------------------------------------------------------------------------------


class Commanded(NamedTuple):
    """A `GatedCommand` has reached the vehicle's gate."""

    now_ms: int
    command: Any


class Wished(NamedTuple):
    """The vehicle's own ICAROUS requests a change of authority from the gate."""

    now_ms: int
    wish: Wish


class Held(NamedTuple):
    """The vehicle's ICAROUS offers a certificate for its next command, or reports that it has none."""

    now_ms: int
    offer: Offers | Uncertified


class Surveyed(NamedTuple):
    """The aircraft in a vehicle's surveillance at a heartbeat."""

    now_ms: int
    intruders: tuple[Intruder, ...]


class LimitsAre(NamedTuple):
    """The airframe limits over the ground from now on."""

    vehicle_id: int
    limits: Limits


class Look(NamedTuple):
    """Publish the vehicle's state. payloads: a `CameraState` per camera; tasks: ids of the tasks that the cameras
    serve."""

    vehicle_id: int
    now_ms: int
    payloads: tuple[Any, ...]
    tasks: tuple[int, ...]


class Sense(NamedTuple):
    """The vehicle's surveillance is due. aircraft: as in `Beat`; cooperating: own vehicles that avoid; landed:
    positions of other own vehicles on the ground; rolling: ids of those in their take-off run."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]
    cooperating: tuple[int, ...]
    landed: tuple[Position, ...] = ()
    rolling: tuple[int, ...] = ()


class Choose(NamedTuple):
    """Choose the velocity of the coming step."""

    now_ms: int


class Move(NamedTuple):
    """Fly the step."""


class OnBoard(NamedTuple):
    """To a vehicle's ICAROUS instance: what the vehicle senses."""

    vehicle_id: int
    sensed: Sensed


ToVehicle = Commanded | Wished | Held | Surveyed | LimitsAre | Look | Sense | Choose | Move
FromVehicle = Say | GateIs | OnBoard | Stands

ToExecutive = (
    Begin
    | SetOut
    | Tick
    | Planned
    | NotPlanned
    | Report
    | Closing
    | Because
    | Suspend
    | TakeBack
    | RouteAsked
    | NotHeard
    | HeardAgain
    | Stands
    | Fails
    | WithoutLink
)
FromExecutive = (
    Proposed | Say | ZonesKnown | Route | Flown | Left | Stop | Look | LimitsAre | AskPlan | Over
)
