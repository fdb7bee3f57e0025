"""The certificate in hand of one vehicle, as transition kernels: what is offered, and what becomes known.

The hand lives behind the actuator gate: where nothing is commanded any more it is flown on. Definitions:
`spec.permit.hand`. `hand_step` is what a vehicle does, event by event;
"""

from typing import NamedTuple

from cratous.core.kernel import kernel

OFFERED, KNOWN, LEFT = 0, 1, 2
"""What happens to a hand: an offer comes; a track or zone becomes known; another trajectory is flown."""


class Hand(NamedTuple):
    """id: which certificate is flown; knowledge: changes of tracks and zones that it allows for;
    expiry_ms: up to when it is clear [ms]; surprises: changes so far that it did not allow for."""

    id: int
    knowledge: int
    expiry_ms: int
    surprises: int


class Offer(NamedTuple):
    """A certificate that agrees with `base` until sigma_ms [ms]; the rest as in `Hand`."""

    id: int
    base: int
    sigma_ms: int
    knowledge: int
    expiry_ms: int


@kernel(implements="permit.hand.may_take_over", nonnegative=("reserve",))
def accepts(hand: Hand, offer: Offer, now: int, reserve: int) -> bool:
    """True iff the offer may take the place of the hand.

    now: [ms]; reserve: how much of what is certain must be left [ms], >= 0.
    """
    if offer.base != hand.id or offer.knowledge != hand.knowledge:
        return False
    if offer.sigma_ms < now or offer.sigma_ms > hand.expiry_ms:
        return False
    return offer.expiry_ms >= min(hand.expiry_ms, now + reserve)


@kernel(implements="permit.hand.is_after_offer", nonnegative=("reserve",))
def hand_offered(hand: Hand, offer: Offer, now: int, reserve: int) -> Hand:
    """The hand after an offer has come; arguments as for `accepts`."""
    if accepts(hand, offer, now, reserve):
        return Hand(offer.id, hand.knowledge, offer.expiry_ms, hand.surprises)
    return hand


@kernel(implements="permit.hand.is_after_news")
def hand_told(hand: Hand, permitted: bool, now: int) -> Hand:
    """The hand after a track or zone has become known. permitted: it is, against that too; now: [ms]."""
    if permitted:
        return Hand(hand.id, hand.knowledge + 1, hand.expiry_ms, hand.surprises)
    return Hand(hand.id, hand.knowledge + 1, min(hand.expiry_ms, now), hand.surprises + 1)


@kernel(implements="permit.hand.is_after_time")
def hand_passed(hand: Hand, now: int) -> Hand:
    """The hand at a later instant [ms]: one that has expired holds nothing, and an offer may begin on it."""
    return Hand(hand.id, hand.knowledge, max(hand.expiry_ms, now), hand.surprises)


@kernel(implements="permit.hand.is_after_leaving")
def hand_left(hand: Hand, now: int) -> Hand:
    """Another trajectory is flown from now on [ms]: nothing is certain any more, and no offer that begins on
    the one that was in hand is accepted."""
    return Hand(hand.id + 1, hand.knowledge, min(hand.expiry_ms, now), hand.surprises)


@kernel(implements="permit.hand.is_after_event", nonnegative=("reserve",))
def hand_step(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    """The hand after an event: OFFERED, KNOWN or LEFT, else time has passed alone. offer, permitted: of an
    event of these kinds; now: [ms]; reserve: as for `accepts`."""
    present = hand_passed(hand, now)
    if kind == 0:
        return hand_offered(present, offer, now, reserve)
    if kind == 1:
        return hand_told(present, permitted, now)
    if kind == 2:
        return hand_left(present, now)
    return present
