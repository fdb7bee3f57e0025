"""The certificate in hand of one vehicle, behind its actuator gate: what is taken, and when it is flown on.

What may take its place, what news does to it and when it is over is answered by the kernel `hand_step`. News is what the
vehicle's own surveillance tells at each heartbeat: an intruder that it does not allow for, or one that is not where
it was taken to be; and that the vehicle itself is not where it should be. While ICAROUS has the vehicle and has
not commanded it for more than two heartbeats the autopilot flies the certificate on, and then its hold. Where
there is none, or it has expired, a loiter is flown and said.
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
"""After so many heartbeats without a command of ICAROUS what is in hand is flown on."""
RESERVE_BEATS = 4
"""So many heartbeats at least are to be certain after an offer, if more than that was before."""
NO_OFFER = Offer(0, 0, 0, 0, 0)
SILENT = "no command of ICAROUS for more than two heartbeats"


class Ground(NamedTuple):
    """What does not change: what is kept clear of, and the heartbeat [ms]."""

    daa: Daa
    heartbeat_ms: int

    @property
    def reserve_ms(self) -> int:
        """How much must be certain after an offer [ms]."""
        return RESERVE_BEATS * self.heartbeat_ms


class Change(NamedTuple):
    """One change, as the log has it. kind: a name of HandChange; before, after: the hand; offer: that came, else
    NO_OFFER; permitted: against what has become known; intruder_id: because of whom, 0 for none."""

    kind: str
    before: Hand
    after: Hand
    offer: Offer
    permitted: bool
    intruder_id: int
    reason: str


class InHand(NamedTuple):
    """hand: as the kernels have it; certificate: what it is of, None while there is none; fresh: it was offered for the
    next command; heard_ms: when ICAROUS last commanded or took the vehicle [ms]; without: the last command had no
    certificate, and that was said; flown: it is flown on, since ICAROUS is silent; over: that it has
    expired was said."""

    hand: Hand = EMPTY
    certificate: Certificate | None = None
    fresh: bool = False
    heard_ms: int = 0
    without: bool = False
    flown: bool = False
    over: bool = False


Kept = tuple[InHand, tuple[Change, ...]]


def taken_over(held: InHand, now_ms: int) -> InHand:
    """ICAROUS takes the vehicle."""
    return held._replace(heard_ms=now_ms, without=False)


def offered(held: InHand, certificate: Certificate, now_ms: int, ground: Ground) -> Kept:
    """ICAROUS offers a certificate for what it commands next."""
    before, offer = held.hand, certificate.offer
    taken = accepts(hand_passed(before, now_ms), offer, now_ms, ground.reserve_ms)
    after = hand_step(before, OFFERED, offer, False, now_ms, ground.reserve_ms)
    change = Change("Offered" if taken else "Refused", before, after, offer, False, 0, "")
    if taken:
        held = held._replace(certificate=certificate, fresh=True, without=False, over=False)
    return held._replace(hand=after), (change,)


def uncertified(held: InHand, intruder_id: int, reason: str) -> Kept:
    """ICAROUS has no certificate for what it commands next: said once, until it has one again."""
    change = Change("Missing", held.hand, held.hand, NO_OFFER, False, intruder_id, reason)
    return held._replace(without=True), () if held.without else (change,)


def steered(held: InHand, velocity: Velocity | None, now_ms: int, ground: Ground) -> Kept:
    """ICAROUS has commanded: what is in hand is left unless it is what is flown now. velocity: commanded, if one is."""
    one, fresh = held.certificate, held.fresh
    held = held._replace(heard_ms=now_ms, flown=False, fresh=False)
    if one is None or fresh:
        return held, ()
    if velocity is not None and one.steers(velocity, now_ms):
        return held, ()
    return left(held, now_ms, ground, "ICAROUS steers another manoeuvre")


def left(held: InHand, now_ms: int, ground: Ground, reason: str) -> Kept:
    """Another trajectory is flown than the one in hand."""
    if held.certificate is None:
        return held, ()
    before = held.hand
    after = hand_step(before, LEFT, NO_OFFER, False, now_ms, ground.reserve_ms)
    change = Change("Left", before, after, NO_OFFER, False, 0, reason)
    return held._replace(hand=after, certificate=None, flown=False, over=False), (change,)


def seen(
    held: InHand, own: Position, others: Sequence[Intruder], now_ms: int, ground: Ground
) -> Kept:
    """The vehicle's surveillance at a heartbeat: what has become known since."""
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
    """What the autopilot flies while ICAROUS is silent, None for a loiter where it is; and what there is to say."""
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
