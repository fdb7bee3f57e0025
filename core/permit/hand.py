"""The certificate in hand of one vehicle, as transition kernels: what is offered, and what becomes known.

The hand lives behind the actuator gate: where the link is lost it is flown on. Definitions:
`spec.permit.hand`.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel


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
