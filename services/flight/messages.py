"""What the actors of a flight say to each other: plain values, times in ms of virtual time.

Each message has one receiver: the UxAS end of the bridge, the executive, a vehicle, a planner, the
wire, or (`Say`) everybody on the bus.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.bridge.link import LinkEvent
from cratous.bridge.text_protocol import Message
from cratous.core.authority.gate import Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight.dynamics import AirState, Limits
from cratous.services.icarous.messages import Offers, Sensed, Uncertified, Wish
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Plan, Pose


class Say(NamedTuple):
    """To the bus: publish a body in the name of a sender."""

    body: Any
    source: str


class Down(NamedTuple):
    """To the wire: lines for a vehicle's ICAROUS, in order."""

    vehicle_id: int
    lines: tuple[Message, ...]


# to the UxAS end of the bridge ------------------------------------------------------------------


class Connected(NamedTuple):
    """The connections to the ICAROUS instances of these vehicles stand, for the first time or again."""

    now_ms: int
    vehicle_ids: tuple[int, ...]


class ZonesKnown(NamedTuple):
    """All zones that bind from now on; where those told before do not come first, in the same order, the
    instances forget all and are told anew."""

    zones: tuple[Zone, ...]


class Route(NamedTuple):
    """The way ahead of a vehicle. speed_m_s: planned on it; from_m: where on the vehicle's track its
    first point is [m]."""

    vehicle_id: int
    points: tuple[Position, ...]
    speed_m_s: float
    from_m: float


class Flown(NamedTuple):
    """How far a vehicle is on its track [m]."""

    vehicle_id: int
    s_m: float


class Left(NamedTuple):
    """Where a vehicle has left the path of its task, or where the task begins that it is on its way to."""

    vehicle_id: int
    position: Position


class Beat(NamedTuple):
    """A heartbeat is due. aircraft: the state of everybody by id, in the order of ids."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class Seen(NamedTuple):
    """The state of one vehicle has come from outside. time_ms: its own time; aircraft: as in `Beat`, at
    that time; roll_rad, pitch_rad: of the vehicle."""

    vehicle_id: int
    now_ms: int
    time_ms: int
    aircraft: tuple[tuple[int, AirState], ...]
    roll_rad: float
    pitch_rad: float


class Heard(NamedTuple):
    """A line has come from a vehicle's ICAROUS."""

    vehicle_id: int
    now_ms: int
    line: Message


class Unreadable(NamedTuple):
    """A line has come that cannot be read. text: which, from whom and why."""

    vehicle_id: int
    now_ms: int
    text: str


class Lost(NamedTuple):
    """A vehicle's connection has ended."""

    vehicle_id: int
    now_ms: int
    event: LinkEvent


class GateIs(NamedTuple):
    """A change of a vehicle's gate, as the vehicle reports it."""

    vehicle_id: int
    gate: Gate


class Watch(NamedTuple):
    """Look for instances that have fallen silent. of: those of these vehicles alone, None: all."""

    now_ms: int
    of: frozenset[int] | None = None


# to the executive -------------------------------------------------------------------------------


class Begin(NamedTuple):
    """The mission begins. aircraft: the state of each of its vehicles, by id."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class SetOut(NamedTuple):
    """Everybody is connected: tell the first ways and command the first tracks."""


class Tick(NamedTuple):
    """A step of the flight. aircraft: as in `Begin`."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class Planned(NamedTuple):
    """The plan that was asked for."""

    plan: Plan


class NotPlanned(NamedTuple):
    """No plan satisfies the request. why: the reasons, in words; of: the reasons per task, where known."""

    why: str
    of: tuple[tuple[int, str], ...] = ()


class Report(NamedTuple):
    """A heartbeat is due: report where the cameras point and how far each vehicle is along its path."""

    now_ms: int


class Closing(NamedTuple):
    """A step is over: does the flight end? gates: as in `Tick`."""

    now_ms: int
    gates: tuple[tuple[int, Gate], ...]


class Suspend(NamedTuple):
    """ICAROUS has a vehicle. act: what the kernel `link_mode` has answered."""

    vehicle_id: int
    now_ms: int
    act: int


class Because(NamedTuple):
    """The vehicle reports what its ICAROUS does with authority (act: as in `Wish`), and the reason."""

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
    """Where the mission says what is flown without the link: a vehicle's ICAROUS is not heard any more."""

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
    """To the planner: a plan for what is left. known: the mission as it is known; starts: where each
    vehicle is; done: the tasks flown, with start and end [ms]; absent: who takes no part, and why;
    undone: tasks that have ended undone, and why; begun: tasks that have been begun and not ended."""

    now_ms: int
    known: Mission
    starts: tuple[tuple[int, Pose], ...]
    done: tuple[tuple[int, int, int], ...]
    absent: tuple[tuple[int, str], ...]
    undone: tuple[tuple[int, str], ...]
    begun: tuple[int, ...]


class Over(NamedTuple):
    """To the clock: the flight has ended. outcome: how, in one word."""

    outcome: str


class RouteAsked(NamedTuple):
    """To the executive: the ICAROUS that has a vehicle asks for a way from there (start) to a place. number: of the
    request."""

    vehicle_id: int
    start: AirState
    end: Position
    number: int


class Proposed(NamedTuple):
    """The answer to `RouteAsked`: the places of a way, none if there is none. speed_m_s: planned on it."""

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
    """Whether the vehicle's ICAROUS has a certificate for its next command."""

    now_ms: int
    offer: Offers | Uncertified


class Surveyed(NamedTuple):
    """The aircraft that a vehicle's surveillance shows at a heartbeat."""

    now_ms: int
    intruders: tuple[Intruder, ...]


class LimitsAre(NamedTuple):
    """What the airframe can do over the ground from now on."""

    vehicle_id: int
    limits: Limits


class Look(NamedTuple):
    """The state is due. payloads: a `CameraState` per camera; tasks: the ids of those that are looked
    at something for."""

    vehicle_id: int
    now_ms: int
    payloads: tuple[Any, ...]
    tasks: tuple[int, ...]


class Sense(NamedTuple):
    """The vehicle's surveillance is due. aircraft: as in `Beat`; cooperating: those of our own that
    avoid; landed: where those of our own are that are on the ground; rolling: those of them that roll to leave it."""

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
)
FromExecutive = (
    Proposed | Say | ZonesKnown | Route | Flown | Left | Look | LimitsAre | AskPlan | Over
)
