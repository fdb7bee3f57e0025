"""What the actors of a flight say to each other. Plain values; times in ms of virtual time.

Each message has one kind of receiver: the executive, the bridge's end at UxAS, a vehicle, its ICAROUS,
the bridge's wire, or (`Say`) everybody on the bus.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cratous.bridge.link import LinkEvent
from cratous.bridge.text_protocol import Message
from cratous.core.gate import Gate
from cratous.core.manoeuvre import Ability, Motion
from cratous.core.prediction import Intruder
from cratous.services.flight.dynamics import AirState
from cratous.spec.mission import Change, Position, Task


class Say(NamedTuple):
    """To the bus: publish a body in the name of a sender."""

    body: Any
    source: str


class Down(NamedTuple):
    """To the wire: lines for a vehicle's ICAROUS, in order."""

    vehicle_id: int
    lines: tuple[Message, ...]


class Up(NamedTuple):
    """To the wire: lines from a vehicle's ICAROUS to UxAS, in order."""

    vehicle_id: int
    lines: tuple[Message, ...]


# to the executive ---------------------------------------------------------------------------


class Seen(NamedTuple):
    """What a vehicle reports of itself: its state, and the epoch of its gate."""

    vehicle_id: int
    state: AirState
    epoch: int


class Begin(NamedTuple):
    """To the executive: the flight begins with the vehicles as they are seen."""

    now_ms: int
    seen: tuple[Seen, ...]


class SetOut(NamedTuple):
    """To the executive: whoever has to be told the ways is there; command everybody."""

    now_ms: int


class Changed(NamedTuple):
    """To the executive: these changes have become known."""

    now_ms: int
    due: tuple[Change, ...]
    seen: tuple[Seen, ...]


class Step(NamedTuple):
    """To the executive: time has passed, the vehicles are seen here now."""

    now_ms: int
    seen: tuple[Seen, ...]


class Report(NamedTuple):
    """To the executive: say where the cameras look, and how the ways and the progress stand."""

    now_ms: int


class Suspend(NamedTuple):
    """To the executive: ICAROUS has a vehicle."""

    vehicle_id: int
    now_ms: int
    act: int


class TakeBack(NamedTuple):
    """To the executive: a vehicle is offered back; commands of this epoch take it."""

    vehicle_id: int
    now_ms: int
    act: int
    epoch: int


class Close(NamedTuple):
    """To the executive: a step is over. away: vehicles that UxAS does not command; expected: changes
    to come that bring work."""

    now_ms: int
    away: int
    expected: int


class Ended(NamedTuple):
    """To the scheduler: the flight is over. outcome: "complete", "failed" or "limit"."""

    outcome: str


# to the bridge's end at UxAS ------------------------------------------------------------------


class Connected(NamedTuple):
    """The connections to all instances stand."""

    now_ms: int


class Zones(NamedTuple):
    """These zones have become known, numbered on the wire after those before; Lines of GEOFN."""

    zones: tuple[Any, ...]


class Route(NamedTuple):
    """The way ahead of a vehicle. speed_m_s: planned for it; from_m: where on the vehicle's track the
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
    """Where a vehicle has left the path of its task."""

    vehicle_id: int
    position: Position


class Beat(NamedTuple):
    """A heartbeat is due; aircraft: everybody's state by id, in the order of ids."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


class Heard(NamedTuple):
    """A line from a vehicle's ICAROUS."""

    vehicle_id: int
    now_ms: int
    line: Message


class Unreadable(NamedTuple):
    """A line that cannot be read; alive: the connection stands."""

    vehicle_id: int
    now_ms: int
    text: str
    alive: bool


class Lost(NamedTuple):
    """A vehicle's connection has ended."""

    vehicle_id: int
    now_ms: int
    event: LinkEvent


class Watch(NamedTuple):
    """Look for those that have fallen silent."""

    now_ms: int


# to a vehicle -----------------------------------------------------------------------------------


class Command(NamedTuple):
    """A `GatedCommand`, for the vehicle's gate."""

    vehicle_id: int
    now_ms: int
    body: Any


class Takeover(NamedTuple):
    """ICAROUS takes over, or withdraws its offer; intruder_id: because of whom, 0 for a zone."""

    vehicle_id: int
    now_ms: int
    reason: str
    intruder_id: int


class Offer(NamedTuple):
    """ICAROUS offers control back."""

    vehicle_id: int
    now_ms: int


class LookAt(NamedTuple):
    """Where the cameras have to look, for which task; None: nowhere."""

    vehicle_id: int
    task: Task | None
    target: Position | None


class TellState(NamedTuple):
    """The vehicle says its state."""

    vehicle_id: int
    now_ms: int


class Sense(NamedTuple):
    """What surveillance on board sees, and the lines that have come down: on to its ICAROUS."""

    vehicle_id: int
    now_ms: int
    intruders: tuple[Intruder, ...]
    lines: tuple[Message, ...]


class Blow(NamedTuple):
    """The wind from now on: north, east [m/s]."""

    vehicle_id: int
    wind: tuple[float, float]


class Steer(NamedTuple):
    """Choose the velocity of the coming step."""

    vehicle_id: int


class Advance(NamedTuple):
    """Fly the step."""

    vehicle_id: int


# to a vehicle's ICAROUS ---------------------------------------------------------------------------


class Think(NamedTuple):
    """A heartbeat on board: what the vehicle knows of itself and of others, and the lines that came."""

    vehicle_id: int
    now_ms: int
    motion: Motion
    ability: Ability
    intruders: tuple[Intruder, ...]
    gate: Gate
    lines: tuple[Message, ...]


ToExecutive = Begin | SetOut | Changed | Step | Report | Suspend | TakeBack | Close
ToLinkEnd = Connected | Zones | Route | Flown | Left | Beat | Heard | Unreadable | Lost | Watch
ToVehicle = Command | Takeover | Offer | LookAt | TellState | Sense | Blow | Steer | Advance
AnyMessage = ToExecutive | ToLinkEnd | ToVehicle | Think | Say | Down | Up | Ended
Handle = Callable[[Any, Any, Any], tuple[Any, tuple[AnyMessage, ...]]]
"""`handle(config, state, message) -> (state, messages)`: the form of every actor."""
