"""The certificate held behind a vehicle's actuator gate: which one is accepted, and when it is flown.

The kernel `hand_step` decides what may replace it, how new surveillance data affect it, and when it expires.
New data at each heartbeat are: an intruder that it does not account for, one that deviates from its
prediction, and a deviation of the vehicle itself. While ICAROUS has the vehicle but has not commanded it for
more than two heartbeats, the autopilot flies the certificate, then its hold. Without a certificate, or after
its expiry, it flies a loiter and reports that.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.prediction import Intruder
from cratous.core.permit.hand import (
    KNOWN,
    LEFT,
    OFFERED,
    Hand,
    Offer,
    accepts,
    hand_passed,
    hand_step,
)
from cratous.services.flight.autopilot import Circle, Command, Fly
from cratous.services.icarous.certificate import Certificate
from cratous.services.icarous.messages import EMPTY
from cratous.spec.mission import Daa, Position, Velocity

BEATS = 2
"""Number of heartbeats without a command of ICAROUS after which the held certificate is flown."""
RESERVE_BEATS = 4
"""Fewest heartbeats that a newly offered certificate must cover, unless the present one covers less."""
NO_OFFER = Offer(0, 0, 0, 0, 0)
SILENT = "no command of ICAROUS for more than two heartbeats"


class Ground(NamedTuple):
    """Fixed parameters: the volume to stay clear of, and the heartbeat [ms]."""

    daa: Daa
    heartbeat_ms: int

    @property
    def reserve_ms(self) -> int:
        """Time that an offered certificate must cover [ms]."""
        return RESERVE_BEATS * self.heartbeat_ms


class Change(NamedTuple):
    """One change of the held certificate, as logged. kind: a name of HandChange; before, after: the hand;
    offer: the offer made, else NO_OFFER; permitted: whether it stays permitted in view of the new data;
    intruder_id: the intruder concerned, 0 for none.
    """

    kind: str
    before: Hand
    after: Hand
    offer: Offer
    permitted: bool
    intruder_id: int
    reason: str


class InHand(NamedTuple):
    """State of the held certificate.

    hand: as the kernels have it; certificate: the one held, None for none; fresh: it was offered for the next
    command; heard_ms: when ICAROUS last commanded or took the vehicle [ms]; without: the last command had no
    certificate, and that was reported; flown: the autopilot flies it because ICAROUS is silent; over: its
    expiry was reported.
    """

    hand: Hand = EMPTY
    certificate: Certificate | None = None
    fresh: bool = False
    heard_ms: int = 0
    without: bool = False
    flown: bool = False
    over: bool = False


Kept = tuple[InHand, tuple[Change, ...]]


def taken_over(held: InHand, now_ms: int) -> InHand:
    """The state after ICAROUS has taken the vehicle."""
    return held._replace(heard_ms=now_ms, without=False)


def offered(held: InHand, certificate: Certificate, now_ms: int, ground: Ground) -> Kept:
    """ICAROUS offers a certificate for its next command: accepted or refused."""
    before, offer = held.hand, certificate.offer
    taken = accepts(hand_passed(before, now_ms), offer, now_ms, ground.reserve_ms)
    after = hand_step(before, OFFERED, offer, False, now_ms, ground.reserve_ms)
    change = Change("Offered" if taken else "Refused", before, after, offer, False, 0, "")
    if taken:
        held = held._replace(certificate=certificate, fresh=True, without=False, over=False)
    return held._replace(hand=after), (change,)


def uncertified(held: InHand, intruder_id: int, reason: str) -> Kept:
    """ICAROUS has no certificate for its next command: reported once, until it has one again."""
    change = Change("Missing", held.hand, held.hand, NO_OFFER, False, intruder_id, reason)
    return held._replace(without=True), () if held.without else (change,)


def steered(held: InHand, velocity: Velocity | None, now_ms: int, ground: Ground) -> Kept:
    """ICAROUS has commanded: the held certificate is dropped unless the command follows it. velocity: the
    commanded one, None if the command is not a velocity.
    """
    one, fresh = held.certificate, held.fresh
    held = held._replace(heard_ms=now_ms, flown=False, fresh=False)
    if one is None or fresh:
        return held, ()
    if velocity is not None and one.steers(velocity, now_ms):
        return held, ()
    return left(held, now_ms, ground, "ICAROUS steers another manoeuvre")


def left(held: InHand, now_ms: int, ground: Ground, reason: str) -> Kept:
    """Another trajectory is flown: the certificate is dropped, and no offer made before is accepted any more, even if
    none was held. Only a held one is reported.
    """
    before = held.hand
    after = hand_step(before, LEFT, NO_OFFER, False, now_ms, ground.reserve_ms)
    change = Change("Left", before, after, NO_OFFER, False, 0, reason)
    changes = () if held.certificate is None else (change,)
    return held._replace(hand=after, certificate=None, flown=False, over=False), changes


def seen(
    held: InHand, own: Position, others: Sequence[Intruder], now_ms: int, ground: Ground
) -> Kept:
    """Check the held certificate against the vehicle's surveillance at a heartbeat."""
    said = list[Change]()
    one = held.certificate
    if one is not None and not one.is_on_it(own, now_ms):
        held, change = _told(
            held, False, now_ms, ground, 0, "the vehicle is off what was permitted"
        )
        said.append(change)
    for other in others:
        one = held.certificate
        if one is None or lasted(held.hand.expiry_ms, now_ms, 0):
            break
        if one.knows(other, now_ms, ground.daa):
            continue
        permitted = one.permits(other, now_ms, ground.daa)
        old = one.allows_for(other.id)
        reason = "it does not fly as predicted" if old else "it was not known"
        held, change = _told(held, permitted, now_ms, ground, other.id, reason)
        held = held._replace(certificate=one.with_track(other, now_ms))
        said.append(change)
    return held, tuple(said)


def _told(
    held: InHand, permitted: bool, now_ms: int, ground: Ground, who: int, reason: str
) -> tuple[InHand, Change]:
    before = held.hand
    asked = Offer(before.id, before.id, now_ms, before.knowledge + 1, before.expiry_ms)
    after = hand_step(before, KNOWN, asked, permitted, now_ms, ground.reserve_ms)
    change = Change("Known", before, after, NO_OFFER, permitted, who, reason)
    return held._replace(hand=after), change


def silent(held: InHand, now_ms: int, ground: Ground) -> bool:
    """Whether ICAROUS, which has the vehicle, has not commanded for more than two heartbeats."""
    return not in_time(held.heard_ms, now_ms, BEATS * ground.heartbeat_ms)


def flown_on(
    held: InHand, now_ms: int, speed_m_s: float
) -> tuple[InHand, Command | None, tuple[Change, ...]]:
    """What the autopilot flies while ICAROUS is silent (None: a loiter where it is), and the changes to
    report.
    """
    said = list[Change]()
    one, hand = held.certificate, held.hand
    if not held.flown:
        kind = "Missing" if one is None else "Flown"
        said.append(Change(kind, hand, hand, NO_OFFER, False, 0, SILENT))
        held = held._replace(flown=True)
    if one is None:
        return held, None, tuple(said)
    if lasted(hand.expiry_ms, now_ms, 0) and not held.over:
        said.append(Change("Expired", hand, hand, NO_OFFER, False, 0, SILENT))
        held = held._replace(over=True)
    if not one.turns_into_hold(now_ms):
        return held, Fly(one.velocity(now_ms)), tuple(said)
    return held, None if one.hold is None else Circle(one.hold, speed_m_s), tuple(said)
