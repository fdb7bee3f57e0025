"""The certificate in hand of one vehicle, as transition kernels: offers, and what becomes known.

The hand is kept behind the actuator gate: it is flown on when nothing is commanded any more. Definitions:
`spec.permit.hand`. `hand_step` is what a vehicle does, event by event; `hand_after` folds any number of them.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel

OFFERED, KNOWN, LEFT = 0, 1, 2
"""Events of a hand: an offer arrives; a track or zone becomes known; another trajectory is flown."""


class Hand(NamedTuple):
    """id: the certificate that is flown; knowledge: changes of tracks and zones that it covers; expiry_ms: until when
    it is clear [ms]; surprises: changes so far that it did not cover.
    """

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

    now: [ms]; reserve: least remaining time of the certificate [ms], >= 0.
    """
    if offer.base != hand.id or offer.id <= hand.id or offer.knowledge != hand.knowledge:
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
    """The hand at a later instant [ms]: an expired one guarantees nothing, and an offer may begin on it."""
    return Hand(hand.id, hand.knowledge, max(hand.expiry_ms, now), hand.surprises)


@kernel(implements="permit.hand.is_after_leaving")
def hand_left(hand: Hand, now: int) -> Hand:
    """Another trajectory is flown from now on [ms]: nothing is guaranteed any more, and no offer based on the
    previous hand is accepted.
    """
    return Hand(hand.id + 1, hand.knowledge, min(hand.expiry_ms, now), hand.surprises)


@kernel(supports="hand_step")
def news_for(hand: Hand, news: Offer) -> bool:
    """True iff the answer about a track or zone refers to the hand itself: its id, up to its expiry, with the next
    change. news: the certificate that was asked about.
    """
    same = news.id == hand.id and news.knowledge == hand.knowledge + 1
    return same and news.expiry_ms >= hand.expiry_ms


@kernel(supports="hand_step")
def worn(hand: Hand) -> bool:
    """True iff it has been changed so often that one more change could not be counted."""
    most = 1152921504606846976
    return hand.id >= most or hand.knowledge >= most or hand.surprises >= most


@kernel(implements="permit.hand.is_after_event", nonnegative=("reserve",))
def hand_step(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    """The hand after an event: OFFERED, KNOWN or LEFT; for any other code only time has passed. offer: the
    certificate offered, or the one checked against what has become known; now: [ms]; reserve: as for `accepts`.
    """
    present = hand_passed(hand, now)
    if worn(present):
        until = min(present.expiry_ms, now)
        return Hand(present.id, present.knowledge, until, present.surprises)
    if kind == 0:
        return hand_offered(present, offer, now, reserve)
    if kind == 1:
        return hand_told(present, permitted and news_for(present, offer), now)
    if kind == 2:
        return hand_left(present, now)
    return present


hand_after = fold(
    name="hand_after",
    implements="permit.hand.certified",
    step=hand_step,
    start=Hand(0, 0, 0, 0),
)
