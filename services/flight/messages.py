"""What the actors of a flight say to each other: plain values, times in ms of virtual time.

Each message has one receiver: the UxAS end of the bridge, the executive, the wire, or (`Say`)
everybody on the bus.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.bridge.link import LinkEvent
from cratous.bridge.text_protocol import Message
from cratous.services.flight.dynamics import AirState
from cratous.spec.mission import Position, Zone


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
    """The connections to the ICAROUS instances of these vehicles stand."""

    now_ms: int
    vehicle_ids: tuple[int, ...]


class ZonesKnown(NamedTuple):
    """All zones that bind from now on; those told before come first, in the same order."""

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
    """Where a vehicle has left the path of its task."""

    vehicle_id: int
    position: Position


class Beat(NamedTuple):
    """A heartbeat is due. aircraft: the state of everybody by id, in the order of ids."""

    now_ms: int
    aircraft: tuple[tuple[int, AirState], ...]


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


class Watch(NamedTuple):
    """Look for instances that have fallen silent."""

    now_ms: int


# to the executive -------------------------------------------------------------------------------


class Suspend(NamedTuple):
    """ICAROUS has a vehicle. act: what the kernel `link_mode` has answered."""

    vehicle_id: int
    now_ms: int
    act: int


class TakeBack(NamedTuple):
    """A vehicle is offered back; commands of this epoch take it. act: as in `Suspend`."""

    vehicle_id: int
    now_ms: int
    act: int
    epoch: int


ToLinkEnd = Connected | ZonesKnown | Route | Flown | Left | Beat | Heard | Unreadable | Lost | Watch
FromLinkEnd = Say | Down | Suspend | TakeBack
