"""The messages between a vehicle and its ICAROUS instance: plain values, times in ms of virtual time.

To the instance: lines received over the bridge, and at each heartbeat what the vehicle senses. From it, in
this order: alerts and bands, its request to the gate, predicted conflicts, a certificate for the manoeuvre or
why there is none, the velocity to fly, lines to UxAS.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from cratous.bridge.text_protocol import Message
from cratous.core.authority.cognition import Conditions
from cratous.core.authority.failure import Seen
from cratous.core.authority.failure_due import Due
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
"""No certificate is held, and nothing has become known."""

# to the instance --------------------------------------------------------------------------------


class Line(NamedTuple):
    """A line from UxAS, received over the bridge."""

    now_ms: int
    line: Message


class Sensed(NamedTuple):
    """A heartbeat is due.

    motion, ability: of the vehicle itself; intruders: all others, as its surveillance sees them; gate: its
    actuator gate; here: uncertainty of the vehicle's own position; hand: the held certificate; landed: it is
    on the ground; taken: names of landing sites on which another vehicle stands; on_ground: it has not taken
    off yet; rolling: ids of other own vehicles in their take-off run.
    """

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
    """The message of another vehicle that merges at the same fix, over the direct link."""

    now_ms: int
    said: Said


# from the instance ------------------------------------------------------------------------------


class Wish(NamedTuple):
    """To the gate. act: result of the kernels of `core.authority.cycle`, for `gate_wished`; intruder_id: the
    intruder concerned, 0 for none.
    """

    vehicle_id: int
    act: int
    reason: str
    intruder_id: int


class Foresees(NamedTuple):
    """To the record: a manoeuvre in words, and the predicted loss that it avoids (intruder, seconds); 0 and
    -1 if there is no new prediction.
    """

    vehicle_id: int
    now_ms: int
    intruder_id: int
    first_violation_s: float
    resolution: str


class WithoutLink(NamedTuple):
    """To the record. mode, chosen: the behaviour flown while UxAS is not heard, and that set by the mission,
    as codes of `core.authority.link_loss`; heard_ms: when UxAS was last heard.
    """

    vehicle_id: int
    now_ms: int
    mode: int
    chosen: int
    heard_ms: int
    reason: str


class Fails(NamedTuple):
    """To the record and to UxAS: a declared failure, as a code of `core.authority.failure`, and the intruder concerned,
    0 for none.
    """

    vehicle_id: int
    now_ms: int
    failure: int
    intruder_id: int
    reason: str


class Checks(NamedTuple):
    """To the record, at each heartbeat until a failure is declared: what it follows from, and which one is due next.

    on_ground: it has not taken off yet; seen, due: as in `core.authority.failure_due`.
    """

    vehicle_id: int
    now_ms: int
    on_ground: bool
    seen: Seen
    due: Due


class TakesOff(NamedTuple):
    """To the record. mode: the vehicle's take-off mode, as a code of `core.authority.take_off`; heard_ms:
    when UxAS was last heard.
    """

    vehicle_id: int
    now_ms: int
    mode: int
    heard_ms: int
    reason: str


class Merges(NamedTuple):
    """To the record: how the vehicle merges.

    stage: from now on, numbered as in `core.merging.stages`; term, leader: of the election, leader 0 for none;
    request: number of its present request, 0 for none; slot: at the fix [ms], -1 for none.
    """

    vehicle_id: int
    now_ms: int
    stage: int
    term: int
    leader: int
    request: int
    slot: int
    reason: str


class Decides(NamedTuple):
    """To the record: the mode from now on, and how a conflict is avoided, as codes of `spec.authority.cognition`;
    intruder_id: an aircraft that is avoided, 0 if none is known; skipped: number of waypoints left out since ICAROUS took
    the vehicle; seen: the conditions.
    """

    vehicle_id: int
    now_ms: int
    mode: int
    resolution: int
    intruder_id: int
    skipped: int
    seen: Conditions


class Tells(NamedTuple):
    """To the other vehicles that merge at the same fix, over the direct links."""

    vehicle_id: int
    said: Said


class Hears(NamedTuple):
    """To the record: whether UxAS is heard, sent when that changes; last_ms: when its last line arrived."""

    vehicle_id: int
    now_ms: int
    heard: bool
    last_ms: int


class Guides(NamedTuple):
    """To the record: a vehicle's alerts and bands in this motion at now_ms [ms]."""

    vehicle_id: int
    now_ms: int
    motion: Motion
    instant: Instant


class Offers(NamedTuple):
    """To the gate: a certificate for the next command."""

    vehicle_id: int
    certificate: Certificate


class Uncertified(NamedTuple):
    """To the gate: the next command is not permitted. intruder_id: the intruder concerned, 0 for a zone."""

    vehicle_id: int
    intruder_id: int
    reason: str


class Steer(NamedTuple):
    """To the autopilot, through the gate: fly this velocity, commanded in this epoch."""

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
    | Fails
    | Checks
    | TakesOff
    | Merges
    | Decides
    | Tells
    | Offers
    | Uncertified
    | Steer
    | Up
)
