"""What must be true of the certificate in hand, behind the actuator gate, and of what may take its place.

A certificate says: flown from now on, its trajectory is clear of all that its tracks may do until it expires,
at every instant before. It names the one that it begins on, which it agrees with until it begins. Whatever is
lost, comes twice, late or in another order, only such a one may take its place. Milliseconds of one clock.
"""

from __future__ import annotations

from typing import NamedTuple


class Hand(NamedTuple):
    """The certificate in hand. id: which; knowledge: how many changes of the set of tracks and zones it
    knows; expiry_ms: up to when it is clear; surprises: what became known and was not allowed for."""

    id: int
    knowledge: int
    expiry_ms: int
    surprises: int


class Offer(NamedTuple):
    """A certificate that is offered. base: the one that it begins on, at sigma_ms; the rest as in `Hand`."""

    id: int
    base: int
    sigma_ms: int
    knowledge: int
    expiry_ms: int


def certified(expiry: int, clear: bool, now: int, at: int) -> bool:
    """Of this instant it is true that the vehicle is clear, if it is one from now until the expiry. FOR
    ALL at. clear: the vehicle is, at this instant, if it flies the trajectory."""
    return clear or at < now or at >= expiry


def agrees(sigma: int, clear: bool, base_clear: bool, at: int) -> bool:
    """Before a trajectory begins it is the one that it begins on: both are clear, or neither. FOR ALL at."""
    return at >= sigma or clear == base_clear


def lasts(before: int, after: int, now: int, reserve: int) -> bool:
    """An expiry falls at most to the reserve from now on; it need not, to fly on near one that hovers."""
    return after >= before or after >= now + reserve


def may_take_over(hand: Hand, offer: Offer, now: int, reserve: int) -> bool:
    """An offer may take the place of the hand: it begins on it, neither in the past nor after its expiry,
    allows for all that is known, and does not shorten what is certain by too much."""
    in_time = not (offer.sigma_ms < now or offer.sigma_ms > hand.expiry_ms)
    knows = offer.base == hand.id and offer.knowledge == hand.knowledge
    return knows and in_time and lasts(hand.expiry_ms, offer.expiry_ms, now, reserve)


def is_after_offer(before: Hand, offer: Offer, now: int, reserve: int, after: Hand) -> bool:
    """The hand is the one that was offered if that may take its place; else nothing changes."""
    if not may_take_over(before, offer, now, reserve):
        return after == before
    same = after.knowledge == before.knowledge and after.surprises == before.surprises
    return after.id == offer.id and after.expiry_ms == offer.expiry_ms and same


def is_after_news(before: Hand, permitted: bool, now: int, after: Hand) -> bool:
    """A track or zone has become known. The hand is permitted against it too, and is certain as before; or
    it is a surprise, which is declared, and nothing is certain any more. Offers that do not allow for it
    are not accepted."""
    known = after.id == before.id and after.knowledge == before.knowledge + 1
    if permitted:
        return known and after.expiry_ms == before.expiry_ms and after.surprises == before.surprises
    return known and after.expiry_ms <= now and after.surprises == before.surprises + 1


OFFERED, KNOWN, LEFT = 0, 1, 2


def is_after_time(before: Hand, now: int, after: Hand) -> bool:
    """Time has passed: what has not expired stays as it is; what has holds nothing, from this instant on."""
    same = after.id == before.id and after.knowledge == before.knowledge
    kept = same and after.surprises == before.surprises
    if before.expiry_ms < now:
        return kept and after.expiry_ms == now
    return kept and after.expiry_ms == before.expiry_ms


def is_after_leaving(before: Hand, now: int, after: Hand) -> bool:
    """Another trajectory is flown: nothing is certain any more, and the hand is another one, on which nothing
    begins that was offered before. Nothing has become known."""
    other = after.id > before.id and after.expiry_ms <= now and after.expiry_ms <= before.expiry_ms
    return other and after.knowledge == before.knowledge and after.surprises == before.surprises


def is_news_for(hand: Hand, news: Offer) -> bool:
    """What was asked about is the certificate in hand, up to its expiry, and the change is the next one."""
    later = news.expiry_ms >= hand.expiry_ms
    return news.id == hand.id and news.knowledge == hand.knowledge + 1 and later


MOST = 1 << 60
"""So many changes are counted; of a hand with more nothing is certain."""


def is_worn(hand: Hand) -> bool:
    """It has been changed too often to be counted once more."""
    return hand.id >= MOST or hand.knowledge >= MOST or hand.surprises >= MOST


class Clock(NamedTuple):
    """When the last event was [ms], and whether each so far came no earlier than the one before."""

    now_ms: int
    in_order: bool


def clock_step(
    clock: Clock, kind: int, offer: Offer, permitted: bool, now: int, reserve: int
) -> Clock:
    """One more event."""
    return Clock(now, clock.in_order and not now < clock.now_ms)


def is_after_event(
    before: Hand, kind: int, offer: Offer, permitted: bool, now: int, reserve: int, after: Hand
) -> bool:
    """Time has passed up to the event, and then what the event is for has happened to the hand."""
    present = Hand(before.id, before.knowledge, max(before.expiry_ms, now), before.surprises)
    if is_worn(present):
        same = after.id == present.id and after.knowledge == present.knowledge
        return same and after.surprises == present.surprises and after.expiry_ms == now
    if kind == OFFERED:
        return is_after_offer(present, offer, now, reserve, after)
    if kind == KNOWN:
        return is_after_news(present, permitted and is_news_for(present, offer), now, after)
    if kind == LEFT:
        return is_after_leaving(present, now, after)
    return after == present
