"""The certificate in hand of one vehicle, as transition kernels: what is offered, and what becomes known.

The hand lives behind the actuator gate: where nothing is commanded any more it is flown on. Definitions:
`spec.permit.hand`. `hand_step` is what a vehicle does, event by event; `hand_after` folds any number of them.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel

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


@kernel(supports="hand_step")
def news_for(hand: Hand, news: Offer) -> bool:
    """True iff what was asked about a track or zone is the hand itself: its id, up to its expiry, as what it knows
    next. news: the certificate that was asked about."""
    same = news.id == hand.id and news.knowledge == hand.knowledge + 1
    return same and news.expiry_ms >= hand.expiry_ms


@kernel(supports="hand_step")
def worn(hand: Hand) -> bool:
    """True iff it has been changed so often that one more could not be counted."""
    most = 1152921504606846976
    return hand.id >= most or hand.knowledge >= most or hand.surprises >= most


@kernel(implements="permit.hand.is_after_event", nonnegative=("reserve",))
def hand_step(hand: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int) -> Hand:
    """The hand after an event: OFFERED, KNOWN or LEFT, else time has passed alone. offer: what is offered, or what was
    asked whether it is permitted against what has become known; now: [ms]; reserve: as for `accepts`."""
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
