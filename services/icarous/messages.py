"""What a vehicle and its ICAROUS instance say to each other: plain values, times in ms of virtual time.

To the instance: lines that have come over the bridge, and at each heartbeat what the vehicle senses.
From it, in this order: alerts and bands, what it wants of the gate, what it foresees, a certificate for the manoeuvre or why there is
none, the velocity to fly, lines to UxAS.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from cratous.bridge.text_protocol import Message
from cratous.core.authority.gate import Gate
from cratous.core.avoidance.drift import NONE, Off
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.core.permit.hand import Hand
from cratous.services.icarous.certificate import Certificate
from cratous.services.icarous.merger import Said
from cratous.spec.mission import Velocity

if TYPE_CHECKING:
    from cratous.core.daa.session import Instant

EMPTY = Hand(0, 0, 0, 0)
"""Nothing is in hand, and nothing has become known."""

# to the instance --------------------------------------------------------------------------------


class Line(NamedTuple):
    """A line from UxAS has come over the bridge."""

    now_ms: int
    line: Message


class Sensed(NamedTuple):
    """A heartbeat is due. motion, ability: of the vehicle itself; intruders: everybody else, as its
    surveillance sees them; gate: how its actuator gate stands; here: how far the vehicle may be from where it is
    taken to be; hand: the certificate behind the gate; landed: it is on the ground; taken: the landing
    sites on whose ground somebody else is; on_ground: it has not left the ground yet; rolling: the others of ours that
    roll to leave it."""

    now_ms: int
    motion: Motion
    ability: Ability
    intruders: tuple[Intruder, ...]
    gate: Gate
    here: Off = NONE.here
    hand: Hand = EMPTY
    landed: bool = False
    taken: frozenset[str] = frozenset()
    on_ground: bool = False
    rolling: tuple[int, ...] = ()


class Talk(NamedTuple):
    """Another vehicle that merges at the same fix has said something, over the direct link."""

    now_ms: int
    said: Said


# from the instance ------------------------------------------------------------------------------


class Wish(NamedTuple):
    """To the gate. act: what the kernels of `core.authority.cycle` have answered, for
    `gate_wished`; intruder_id: because of whom, 0 for none."""

    vehicle_id: int
    act: int
    reason: str
    intruder_id: int


class Foresees(NamedTuple):
    """To the record: a manoeuvre in words, and the predicted loss that it avoids, with whom and in how
    many seconds (0 and -1 where there is nothing new of it)."""

    vehicle_id: int
    now_ms: int
    intruder_id: int
    first_violation_s: float
    resolution: str


class WithoutLink(NamedTuple):
    """To the record. mode, chosen: what is flown from now on while UxAS is not heard, and what the mission wants, by
    the numbers of `core.authority.link_loss`; heard_ms: when UxAS was last heard."""

    vehicle_id: int
    now_ms: int
    mode: int
    chosen: int
    heard_ms: int
    reason: str


class TakesOff(NamedTuple):
    """To the record. mode: how the vehicle leaves the ground from now on, by the numbers of `core.authority.take_off`;
    heard_ms: when UxAS was last heard."""

    vehicle_id: int
    now_ms: int
    mode: int
    heard_ms: int
    reason: str


class Merges(NamedTuple):
    """To the record. stage: how the vehicle merges from now on, by the numbers of `core.merging.stages`; term, leader: of
    the election, 0 for nobody; request, slot: its present request, 0 for none, and its slot [ms], -1 for none."""

    vehicle_id: int
    now_ms: int
    stage: int
    term: int
    leader: int
    request: int
    slot: int
    reason: str


class Tells(NamedTuple):
    """To the others that merge at the same fix, over the direct links."""

    vehicle_id: int
    said: Said


class Hears(NamedTuple):
    """To the record: whether UxAS has been heard within the time after which nothing is offered to it, said when that
    changes; last_ms: when a line of its came last."""

    vehicle_id: int
    now_ms: int
    heard: bool
    last_ms: int


class Guides(NamedTuple):
    """To the record: the alerts and bands of a vehicle that flies so at now_ms [ms]."""

    vehicle_id: int
    now_ms: int
    motion: Motion
    instant: Instant


class Offers(NamedTuple):
    """To the gate: a certificate for what is commanded next."""

    vehicle_id: int
    certificate: Certificate


class Uncertified(NamedTuple):
    """To the gate: what is commanded next is not permitted. intruder_id: against whom, 0 for a zone."""

    vehicle_id: int
    intruder_id: int
    reason: str


class Steer(NamedTuple):
    """To the autopilot, through the gate: fly this velocity. epoch: in which it is commanded."""

    vehicle_id: int
    epoch: int
    velocity: Velocity


class Up(NamedTuple):
    """To UxAS, over the bridge: a line."""

    vehicle_id: int
    line: Message


ToInstance = Line | Sensed | Talk
FromInstance = (
    Wish
    | Foresees
    | Hears
    | Guides
    | WithoutLink
    | TakesOff
    | Merges
    | Tells
    | Offers
    | Uncertified
    | Steer
    | Up
)
